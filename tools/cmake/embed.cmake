# Files that the program carries: they become string literals in a source file of the build tree, written again when one
# of them changes, comes or goes.
#   embed_scenes(TARGET FOLDER)             bundled_scenes() of tools/scene/scene.hpp, from the TOML files of a folder
#                                           and of those in it, FOLDER/NAME.toml as NAME and FOLDER/SUB/NAME.toml as SUB/NAME
#   embed_files(TARGET PATTERN FUNCTION)    std::span<const EmbeddedFile> FUNCTION() of tools/plot/FUNCTION.hpp, from all
#                                           files of that pattern
# The same file is the script that writes them: cmake -DFILES=... -DOUTPUT=... [-DFUNCTION=...] [-DROOT=...] -P embed.cmake

function(_embed target output files function root)
  # The list of names is a dependency too: a removed file changes nothing else.
  file(CONFIGURE OUTPUT "${output}.list" CONTENT "${files}\n")
  add_custom_command(
    OUTPUT "${output}"
    COMMAND ${CMAKE_COMMAND} "-DFILES=${files}" "-DOUTPUT=${output}" "-DFUNCTION=${function}" "-DROOT=${root}" -P
            "${CMAKE_CURRENT_FUNCTION_LIST_FILE}"
    DEPENDS ${files} "${CMAKE_CURRENT_FUNCTION_LIST_FILE}" "${output}.list"
    COMMENT "Embedding ${output}"
    VERBATIM)
  target_sources(${target} PRIVATE "${output}")
endfunction()

function(embed_scenes target folder)
  file(GLOB_RECURSE scenes CONFIGURE_DEPENDS "${folder}/*.toml")
  _embed(${target} "${CMAKE_CURRENT_BINARY_DIR}/bundled_scenes.cpp" "${scenes}" "" "${folder}")
endfunction()

function(embed_files target pattern function)
  file(GLOB files CONFIGURE_DEPENDS "${pattern}")
  _embed(${target} "${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp" "${files}" "${function}" "")
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  list(SORT FILES)
  set(code "// Written by embed.cmake.\n")
  if(FUNCTION)
    set(type EmbeddedFile)
    set(header plot/${FUNCTION})
    set(part NAME)
  else()
    set(FUNCTION bundled_scenes)
    set(type BundledScene)
    set(header scene/scene)
    set(part NAME_WLE)
  endif()
  string(APPEND code "#include \"cradle/tools/${header}.hpp\"\n\nnamespace cradle::tools {\nnamespace {\n")
  string(APPEND code "constexpr ${type} ${FUNCTION}_embedded[] = {\n")
  foreach(file IN LISTS FILES)
    get_filename_component(name "${file}" ${part})
    if(ROOT)
      file(RELATIVE_PATH folder "${ROOT}" "${file}")
      get_filename_component(folder "${folder}" DIRECTORY)
      if(folder)
        string(PREPEND name "${folder}/")
      endif()
    endif()
    file(READ "${file}" text)
    string(APPEND code "    {\"${name}\", R\"embedded(${text})embedded\"},\n")
  endforeach()
  string(APPEND code "};\n}  // namespace\n\nstd::span<const ${type}> ${FUNCTION}() { return ${FUNCTION}_embedded; }\n\n")
  string(APPEND code "}  // namespace cradle::tools\n")
  file(WRITE "${OUTPUT}" "${code}")
endif()
