# Files that the program carries: they become string literals in a source file of the build tree, written again when one of
# them changes, comes or goes.
#   embed_scenes(TARGET FOLDER)         bundled_scenes() of tools/scene.hpp, from the TOML files of a folder
#   embed_text(TARGET FILE FUNCTION)    std::string_view FUNCTION(), the text of one file
# The same file is the script that writes them: cmake -DFILES=... -DOUTPUT=... [-DFUNCTION=...] -P embed.cmake

function(_embed target output files function)
  # The list of names is a dependency too: a removed file changes nothing else.
  file(CONFIGURE OUTPUT "${output}.list" CONTENT "${files}\n")
  add_custom_command(
    OUTPUT "${output}"
    COMMAND ${CMAKE_COMMAND} "-DFILES=${files}" "-DOUTPUT=${output}" "-DFUNCTION=${function}" -P
            "${CMAKE_CURRENT_FUNCTION_LIST_FILE}"
    DEPENDS ${files} "${CMAKE_CURRENT_FUNCTION_LIST_FILE}" "${output}.list"
    COMMENT "Embedding ${output}"
    VERBATIM)
  target_sources(${target} PRIVATE "${output}")
endfunction()

function(embed_scenes target folder)
  file(GLOB scenes CONFIGURE_DEPENDS "${folder}/*.toml")
  _embed(${target} "${CMAKE_CURRENT_BINARY_DIR}/bundled_scenes.cpp" "${scenes}" "")
endfunction()

function(embed_text target file function)
  _embed(${target} "${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp" "${file}" "${function}")
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  list(SORT FILES)
  set(code "// Written by embed.cmake.\n")
  if(FUNCTION)
    file(READ "${FILES}" text)
    string(APPEND code "#include \"cradle/tools/${FUNCTION}.hpp\"\n\nnamespace cradle::tools {\n\n")
    string(APPEND code "std::string_view ${FUNCTION}() { return R\"embedded(${text})embedded\"; }\n\n")
  else()
    string(APPEND code "#include \"cradle/tools/scene.hpp\"\n\nnamespace cradle::tools {\nnamespace {\n")
    string(APPEND code "constexpr BundledScene scenes[] = {\n")
    foreach(scene IN LISTS FILES)
      get_filename_component(name "${scene}" NAME_WLE)
      file(READ "${scene}" text)
      string(APPEND code "    {\"${name}\", R\"embedded(${text})embedded\"},\n")
    endforeach()
    string(APPEND code "};\n}  // namespace\n\nstd::span<const BundledScene> bundled_scenes() { return scenes; }\n\n")
  endif()
  string(APPEND code "}  // namespace cradle::tools\n")
  file(WRITE "${OUTPUT}" "${code}")
endif()
