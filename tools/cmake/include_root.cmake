# Sources include each other as cradle/core/..., in the tree as in an installation. Each part has an include root of its
# own, a folder cradle/ with a link to the part in it, so that one sees only what it links: users no tools and no tests.
#   include_root(PART RESULT)     sets RESULT to that folder
function(include_root part result)
  set(root ${PROJECT_BINARY_DIR}/roots/${part})
  file(MAKE_DIRECTORY ${root}/cradle)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${part} ${root}/cradle/${part} SYMBOLIC)
  set(${result} ${root} PARENT_SCOPE)
endfunction()
