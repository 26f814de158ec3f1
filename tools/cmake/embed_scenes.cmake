# Bundled scenes: the TOML files of a folder become string literals in a source file of the build tree.
#   embed_scenes(TARGET FOLDER)  adds that source to TARGET; it is written again when a scene changes, comes or goes.
# The same file is the script that writes it: cmake -DFOLDER=... -DOUTPUT=... -P embed_scenes.cmake

function(embed_scenes target folder)
  file(GLOB scenes CONFIGURE_DEPENDS "${folder}/*.toml")
  set(output "${CMAKE_CURRENT_BINARY_DIR}/bundled_scenes.cpp")
  # The list of names is a dependency too: a removed scene changes nothing else.
  file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/bundled_scenes.list" CONTENT "${scenes}\n")
  add_custom_command(
    OUTPUT "${output}"
    COMMAND ${CMAKE_COMMAND} "-DFOLDER=${folder}" "-DOUTPUT=${output}" -P "${CMAKE_CURRENT_FUNCTION_LIST_FILE}"
    DEPENDS ${scenes} "${CMAKE_CURRENT_FUNCTION_LIST_FILE}" "${CMAKE_CURRENT_BINARY_DIR}/bundled_scenes.list"
    COMMENT "Embedding the bundled scenes"
    VERBATIM)
  target_sources(${target} PRIVATE "${output}")
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  file(GLOB scenes "${FOLDER}/*.toml")
  list(SORT scenes)
  set(code "// Written by embed_scenes.cmake from the files of tools/scenes.\n#include \"cradle/tools/scene.hpp\"\n\n")
  string(APPEND code "namespace cradle::tools {\nnamespace {\nconstexpr BundledScene scenes[] = {\n")
  foreach(scene IN LISTS scenes)
    get_filename_component(name "${scene}" NAME_WLE)
    file(READ "${scene}" text)
    string(APPEND code "    {\"${name}\", R\"scene(${text})scene\"},\n")
  endforeach()
  string(APPEND code "};\n}  // namespace\n\nstd::span<const BundledScene> bundled_scenes() { return scenes; }\n\n")
  string(APPEND code "}  // namespace cradle::tools\n")
  file(WRITE "${OUTPUT}" "${code}")
endif()
