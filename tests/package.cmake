# The test `package`: `cpack -G DEB` of the build tree, unpacked as apt would unpack it; the program runs in it, Python
# finds the package beside it, and the dependencies name the libraries. Skipped without Debian's tools.
# tests/bare_debian.sh tries what apt makes of it on a machine that has nothing. Included from tests/CMakeLists.txt; the
# same file is the script that the test runs. Everything must have been built.

if(NOT CMAKE_SCRIPT_MODE_FILE)
  add_test(NAME package
           COMMAND ${CMAKE_COMMAND} -DTREE=${PROJECT_BINARY_DIR} -DSCRATCH=${PROJECT_BINARY_DIR}/package_test
                   -DCPACK=${CMAKE_CPACK_COMMAND} -DMODULE=$<TARGET_EXISTS:cradle_module> -P ${CMAKE_CURRENT_LIST_FILE})
  set_tests_properties(package PROPERTIES TIMEOUT 600 SKIP_REGULAR_EXPRESSION "skipped: no ")
  return()
endif()

foreach(tool dpkg-deb dpkg-shlibdeps)
  find_program(found_${tool} ${tool})
  if(NOT found_${tool})
    message(STATUS "skipped: no ${tool} (Debian: dpkg-dev)")
    return()
  endif()
endforeach()

file(REMOVE_RECURSE ${SCRATCH})
execute_process(COMMAND ${CPACK} -G DEB --config ${TREE}/CPackConfig.cmake -B ${SCRATCH} OUTPUT_QUIET
                COMMAND_ERROR_IS_FATAL ANY)
file(GLOB package ${SCRATCH}/cradle_*.deb)
execute_process(COMMAND dpkg-deb -x ${package} ${SCRATCH}/root COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND dpkg-deb -f ${package} Depends Recommends OUTPUT_VARIABLE needs COMMAND_ERROR_IS_FATAL ANY)
foreach(need python3 libhdf5 libtbb python3-h5py python3-matplotlib)
  if(NOT needs MATCHES "[ ,]${need}")
    message(FATAL_ERROR "the package does not ask for ${need} (found ${needs})")
  endif()
endforeach()

set(usr ${SCRATCH}/root/usr)
set(files bin/cradle include/cradle/core/engine/simulation.hpp share/man/man1/cradle.1 share/cradle/scenes/fig2.toml
    share/bash-completion/completions/cradle share/zsh/vendor-completions/_cradle
    share/fish/vendor_completions.d/cradle.fish share/doc/cradle/README.md share/doc/cradle/core/README.md
    share/doc/cradle/tools/manual/keys.md lib/python3/dist-packages/cradle/py.typed)
foreach(file IN LISTS files)
  if(NOT EXISTS ${usr}/${file})
    message(FATAL_ERROR "${file} is not in the package: see tools/cmake/install.cmake")
  endif()
endforeach()
file(GLOB module ${usr}/lib/python3/dist-packages/cradle/_live*)
if(MODULE AND NOT module)
  message(FATAL_ERROR "the compiled module is not in the package: see tools/cmake/install.cmake")
endif()

execute_process(COMMAND ${usr}/bin/cradle run fig5 --quiet -o ${SCRATCH}/fig5.h5 COMMAND_ERROR_IS_FATAL ANY)
# Also without h5py: the functions that read nothing find the program from where the package is.
execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=CRADLE_PROGRAM PYTHONDONTWRITEBYTECODE=1
                        PYTHONPATH=${usr}/lib/python3/dist-packages
                        python3 -c "import cradle, cradle.program; print(cradle.program.find())"
                OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
if(NOT found STREQUAL "${usr}/bin/cradle")
  message(FATAL_ERROR "the Python package takes another program (found ${found}): see tools/python/cradle/program.py")
endif()
