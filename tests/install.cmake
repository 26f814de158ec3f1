# The test `install`: cmake --install into a scratch prefix of the build tree (with the manual page, completions,
# documents, scenes and the Python package), then the program in tests/install/ finds
# Cradle there, is built and run; it is compiled without contraction of multiply-adds, which the result depends on, and
# sees the library alone. The same with Cradle in a subfolder of its own tree; and where a library is missing,
# find_package(cradle) says so instead of ending the user's configuration. Included from tests/CMakeLists.txt; the same
# file is the script that the test runs. Everything must have been built.

if(NOT CMAKE_SCRIPT_MODE_FILE)
  add_test(NAME install
           COMMAND ${CMAKE_COMMAND} -DTREE=${PROJECT_BINARY_DIR} -DSCRATCH=${PROJECT_BINARY_DIR}/install_test
                   -DCONSUMER=${PROJECT_SOURCE_DIR}/tests/install -DGENERATOR=${CMAKE_GENERATOR}
                   -DCOMPILER=${CMAKE_CXX_COMPILER} -DTYPE=${CMAKE_BUILD_TYPE} -DFLAGS=${CMAKE_CXX_FLAGS}
                   "-DPREFIXES=${CMAKE_PREFIX_PATH}" -P ${CMAKE_CURRENT_LIST_FILE})
  set_tests_properties(install PROPERTIES TIMEOUT 600)
  return()
endif()

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${TREE} --prefix ${SCRATCH}/prefix OUTPUT_QUIET
                COMMAND_ERROR_IS_FATAL ANY)
list(PREPEND PREFIXES ${SCRATCH}/prefix)
list(JOIN PREFIXES "\\;" PREFIXES)
function(configure folder)
  run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${SCRATCH}/${folder} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
      -DCMAKE_BUILD_TYPE=${TYPE} -DCMAKE_CXX_FLAGS=${FLAGS} "-DCMAKE_PREFIX_PATH=${PREFIXES}" ${ARGN})
endfunction()

function(check_commands folder)
  file(READ ${SCRATCH}/${folder}/compile_commands.json commands)
  if(NOT commands MATCHES "-ffp-contract=off")
    message(FATAL_ERROR "the consumer is compiled without -ffp-contract=off: cradle::cradle must hand it on")
  endif()
  if(commands MATCHES "-march=")
    message(FATAL_ERROR "the consumer is compiled with -march (found ${CMAKE_MATCH_0}): "
                        "that is for Cradle's own sources")
  endif()
  string(REGEX MATCHALL "-I *[^ ]+" roots "${commands}")
  foreach(root IN LISTS roots)
    string(REGEX REPLACE "-I *" "" root "${root}")
    file(GLOB parts RELATIVE ${root}/cradle ${root}/cradle/*)
    list(REMOVE_ITEM parts core precision)
    if(parts)
      message(FATAL_ERROR "the consumer sees more than the library (found ${parts} in ${root}/cradle)")
    endif()
  endforeach()
endfunction()

foreach(file bin/cradle share/man/man1/cradle.1 share/bash-completion/completions/cradle
             share/zsh/site-functions/_cradle
             share/fish/vendor_completions.d/cradle.fish share/doc/cradle/core/README.md share/doc/cradle/core/laws/README.md
             share/doc/cradle/precision/README.md share/cradle/scenes/fig2.toml
             share/cradle/python/cradle/__init__.py
             share/cradle/python/cradle/page/page.css share/cradle/python/cradle/cite.bib)
  if(NOT EXISTS ${SCRATCH}/prefix/${file})
    message(FATAL_ERROR "${file} is not installed: see tools/cmake/install.cmake")
  endif()
endforeach()

file(GLOB module RELATIVE ${TREE}/tools ${TREE}/tools/_live*.so)
if(module AND NOT EXISTS ${SCRATCH}/prefix/share/cradle/python/cradle/${module})
  message(FATAL_ERROR "the Python module ${module} is not installed beside the package: see tools/cmake/install.cmake")
endif()

configure(build)
check_commands(build)
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/consumer)

configure(within -DCRADLE_SOURCE=${CONSUMER}/../..)
check_commands(within)

foreach(missing TBB Boost)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${CONSUMER} -B ${SCRATCH}/without_${missing} -G ${GENERATOR}
                          -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_PREFIX_PATH=${PREFIXES}" -DCRADLE_MAY_BE_MISSING=ON
                          -DCMAKE_DISABLE_FIND_PACKAGE_${missing}=ON
                  OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  if(NOT output MATCHES "cradle_FOUND=(0|FALSE)")
    message(FATAL_ERROR "find_package(cradle QUIET) without ${missing}: expected cradle_FOUND=0 (found ${output})")
  endif()
endforeach()
