# The tower: each folder is a target with an include root of its own and the list of the folders that it uses, so that
# nothing else can be included or called. tests/ compiles and links each alone; tower.txt in the build tree is the list,
# which the architecture test reads.
#   cradle_part(FOLDER [QUICK] [USES FOLDER...] [LIBRARIES TARGET...] [PRIVATE TARGET...] [FAST SOURCE...]
#               [WITHOUT SOURCE...])
#     cradle_core_base for core/base. QUICK: compiled to be compiled quickly, except for the sources that are FAST.
#     LIBRARIES are passed on to those who use the part, PRIVATE ones are not. WITHOUT: sources that others compile.
function(cradle_part folder)
  cmake_parse_arguments(PART "QUICK" "" "USES;LIBRARIES;PRIVATE;FAST;WITHOUT" ${ARGN})
  string(MAKE_C_IDENTIFIER "cradle_${folder}" name)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
  foreach(source IN LISTS PART_WITHOUT)
    list(REMOVE_ITEM sources ${PROJECT_SOURCE_DIR}/${folder}/${source})
  endforeach()
  set(scope INTERFACE)
  if(sources)
    set(scope PUBLIC)
    add_library(${name} STATIC ${sources})
    target_link_libraries(${name} PRIVATE cradle_build ${PART_PRIVATE})
    set_target_properties(${name} PROPERTIES UNITY_BUILD_BATCH_SIZE 12)
    if(PART_QUICK)
      target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
    endif()
    foreach(source IN LISTS PART_FAST)
      set_source_files_properties(${PROJECT_SOURCE_DIR}/${folder}/${source} PROPERTIES
                                  SKIP_UNITY_BUILD_INCLUSION ON COMPILE_OPTIONS $<$<CONFIG:Release>:-O3>)
    endforeach()
  else()
    add_library(${name} INTERFACE)
  endif()
  include_root(${folder} root)
  target_include_directories(${name} ${scope} ${root})
  target_link_libraries(${name} ${scope} cradle_options ${PART_LIBRARIES})
  foreach(part IN LISTS PART_USES)
    string(MAKE_C_IDENTIFIER "cradle_${part}" used)
    target_link_libraries(${name} ${scope} ${used})
  endforeach()
  list_part(${folder} ${PART_USES})
endfunction()

# A part of the tower that is a target in another way.
function(list_part folder)
  list(JOIN ARGN " " uses)
  set_property(GLOBAL APPEND PROPERTY CRADLE_PARTS ${folder})
  set_property(GLOBAL APPEND_STRING PROPERTY CRADLE_TOWER "${folder}: ${uses}\n")
endfunction()
