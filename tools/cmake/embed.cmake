# Files that the program carries: they become string literals in a source file of the build tree, written again when one
# of them changes, comes or goes.
#   embed_scenes(TARGET FOLDER)             bundled_scenes() of tools/scene/scene.hpp, from the TOML files of a folder
#                                           and those in it: FOLDER/NAME.toml as NAME, FOLDER/SUB/NAME.toml as SUB/NAME
#   embed_package(TARGET FOLDER FUNCTION HEADER)  std::span<const EmbeddedFile> FUNCTION() of tools/HEADER, from what a
#                                           Python package in FOLDER is made of, by its names from the folder above
# The same file is the script that writes them:
#   cmake -DFILES=... -DOUTPUT=... -DFROM=... [-DFUNCTION=... -DHEADER=...] -P embed.cmake

# `from`: the folder that names are relative to. Further arguments: the header of the function.
function(_embed target output files from function)
  # The list of names is a dependency too: a removed file changes nothing else.
  file(CONFIGURE OUTPUT "${output}.list" CONTENT "${files}\n")
  add_custom_command(
    OUTPUT "${output}"
    COMMAND ${CMAKE_COMMAND} "-DFILES=${files}" "-DOUTPUT=${output}" "-DFROM=${from}" "-DFUNCTION=${function}"
            "-DHEADER=${ARGV5}" -P "${CMAKE_CURRENT_FUNCTION_LIST_FILE}"
    DEPENDS ${files} "${CMAKE_CURRENT_FUNCTION_LIST_FILE}" "${output}.list"
    COMMENT "Embedding ${output}"
    VERBATIM)
  target_sources(${target} PRIVATE "${output}")
endfunction()

function(embed_scenes target folder)
  file(GLOB_RECURSE scenes CONFIGURE_DEPENDS "${folder}/*.toml")
  _embed(${target} "${CMAKE_CURRENT_BINARY_DIR}/bundled_scenes.cpp" "${scenes}" "${folder}" "")
endfunction()

function(embed_package target folder function header)
  set(patterns "")
  foreach(ending py css js bib html)
    list(APPEND patterns "${folder}/*.${ending}")
  endforeach()
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${patterns})
  get_filename_component(above "${folder}" DIRECTORY)
  _embed(${target} "${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp" "${files}" "${above}" "${function}" "${header}")
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  list(SORT FILES)
  set(code "// Written by embed.cmake.\n")
  set(scenes FALSE)
  if(NOT FUNCTION)
    set(scenes TRUE)
    set(FUNCTION bundled_scenes)
    set(HEADER scene/scene.hpp)
  endif()
  string(APPEND code "#include \"cradle/tools/${HEADER}\"\n\nnamespace cradle::tools {\nnamespace {\n")
  string(APPEND code "constexpr EmbeddedFile ${FUNCTION}_embedded[] = {\n")
  foreach(file IN LISTS FILES)
    file(RELATIVE_PATH name "${FROM}" "${file}")
    if(scenes)
      string(REGEX REPLACE "\\.toml$" "" name "${name}")
    endif()
    file(READ "${file}" text)
    string(APPEND code "    {\"${name}\", R\"embedded(${text})embedded\"},\n")
  endforeach()
  string(APPEND code "};\n}  // namespace\n\n"
                     "std::span<const EmbeddedFile> ${FUNCTION}() { return ${FUNCTION}_embedded; }\n\n")
  string(APPEND code "}  // namespace cradle::tools\n")
  file(WRITE "${OUTPUT}" "${code}")
endif()
