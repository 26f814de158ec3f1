# The test `install`: cmake --install into a scratch prefix of the build tree, then the program in tests/install/ finds
# Cradle there, is built and run; and it is compiled without contraction of multiply-adds, which the result depends on.
# Included from tests/CMakeLists.txt; the same file is the script that the test runs. Everything must have been built.

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
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${SCRATCH}/build -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_BUILD_TYPE=${TYPE} -DCMAKE_CXX_FLAGS=${FLAGS} "-DCMAKE_PREFIX_PATH=${PREFIXES}")
file(READ ${SCRATCH}/build/compile_commands.json commands)
if(NOT commands MATCHES "-ffp-contract=off")
  message(FATAL_ERROR "the consumer is compiled without -ffp-contract=off: cradle::cradle must hand it on")
endif()
if(commands MATCHES "-march=")
  message(FATAL_ERROR "the consumer is compiled with -march (found ${CMAKE_MATCH_0}): that is for Cradle's own sources")
endif()
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/consumer)
