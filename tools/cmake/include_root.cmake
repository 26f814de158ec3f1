# Sources include each other as cradle/core/..., in the tree as in an installation. Each part has an include root of its
# own, a folder cradle/ with a link to the part in it, so that one sees only what it links: users no tools and no tests.
#   include_root(PART RESULT)     sets RESULT to that folder
function(include_root part result)
  string(MAKE_C_IDENTIFIER ${part} name)
  set(root ${PROJECT_BINARY_DIR}/roots/${name})
  get_filename_component(above ${root}/cradle/${part} DIRECTORY)
  file(MAKE_DIRECTORY ${above})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${part} ${root}/cradle/${part} SYMBOLIC)
  set(${result} ${root} PARENT_SCOPE)
endfunction()
