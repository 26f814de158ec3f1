# Compiler options that every target shares. Results must have the same bits on every build, so contraction of
# multiply-adds is off and anything that lets the compiler rearrange arithmetic is refused.

string(TOUPPER "${CMAKE_BUILD_TYPE}" _type)
foreach(_flags CMAKE_CXX_FLAGS CMAKE_CXX_FLAGS_${_type})
  set(_unsafe "ffast-math|Ofast|funsafe-math-optimizations|fassociative-math|freciprocal-math|ffinite-math-only")
  if("${${_flags}}" MATCHES "-(${_unsafe}|fno-signed-zeros)")
    message(FATAL_ERROR "fast-math rearranges floating-point arithmetic (found ${CMAKE_MATCH_0} in ${_flags}): "
                        "remove it, Cradle's error bounds and its reproducibility depend on exact IEEE operations")
  endif()
endforeach()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# Libraries outside the system's folders (modules, conda) are found at run time.
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)

add_library(cradle_options INTERFACE)
target_compile_features(cradle_options INTERFACE cxx_std_20)
target_compile_options(cradle_options INTERFACE -ffp-contract=off
                       # Else g++ may call sqrt for what is one instruction, for the sake of errno, which nobody reads.
                       -fno-math-errno
                       # g++ would store two members of a gap in one piece, which are read one by one a collision later:
                       # processors cannot hand on parts of a store (bench/results/trials.md: a tenth of the time of a
                       # collision).
                       $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)

# Private to the project's own sources: warnings and the machine's instruction set.
add_library(cradle_build INTERFACE)
target_link_libraries(cradle_build INTERFACE cradle_options)
target_compile_options(cradle_build INTERFACE
                       -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
                       # g++ 12 sees overlap in every `text + ": "` (GCC bug 105329).
                       $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
                       # g++ tidies its memory more rarely: a twelfth less time, 100 to 700 MB more memory.
                       $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>
                       $<$<BOOL:${CRADLE_WERROR}>:-Werror> $<$<BOOL:${CRADLE_ARCH}>:-march=${CRADLE_ARCH}>)
