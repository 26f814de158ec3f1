# The Python module for live simulations (tools/python/module), for the interpreter that pictures take: the first of
# $CRADLE_PYTHON, python3 and /usr/bin/python3 with h5py and numpy. It is built where that one's headers and pybind11
# are found. The libraries it shares with the program are then position-independent; what they define is hidden, so that
# calls within the module stay direct. With sanitizers it is left out: Python would have to be started with theirs.
option(CRADLE_PYTHON_MODULE "build the Python module for live simulations, where Python and pybind11 are found" ON)

function(_find_python result)
  set(${result} "" PARENT_SCOPE)
  foreach(_candidate "$ENV{CRADLE_PYTHON}" python3 /usr/bin/python3)
    if(_candidate)
      execute_process(COMMAND ${_candidate} -c "import sys, h5py, numpy; print(sys.executable)" ERROR_QUIET
                      OUTPUT_VARIABLE _found OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE _failed)
      if(NOT _failed)
        set(${result} ${_found} PARENT_SCOPE)
        return()
      endif()
    endif()
  endforeach()
endfunction()

if(CRADLE_PYTHON_MODULE AND NOT CMAKE_CXX_FLAGS MATCHES fsanitize)
  if(NOT Python_EXECUTABLE)
    _find_python(Python_EXECUTABLE)
  endif()
  if(Python_EXECUTABLE)
    find_package(Python COMPONENTS Interpreter Development.Module QUIET)
    find_package(pybind11 CONFIG QUIET)
  endif()
  if(NOT (Python_Development.Module_FOUND AND pybind11_FOUND))
    message(STATUS "Python module: not built, without a Python that has h5py, its headers and pybind11")
  endif()
endif()

if(Python_Development.Module_FOUND AND pybind11_FOUND)
  message(STATUS "Python module: for ${Python_EXECUTABLE}")
  get_property(_parts GLOBAL PROPERTY CRADLE_PARTS)
  list(FILTER _parts INCLUDE REGEX "^tools/")
  list(REMOVE_ITEM _parts tools/python)
  list(TRANSFORM _parts REPLACE "/" "_")
  list(TRANSFORM _parts PREPEND cradle_)
  foreach(_part IN LISTS _parts)
    if(TARGET ${_part}_fast)
      list(APPEND _parts ${_part}_fast)
    endif()
  endforeach()
  set_target_properties(${_parts} cradle_precision cradle_steps
                        PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                                   VISIBILITY_INLINES_HIDDEN ON)
  pybind11_add_module(cradle_module MODULE NO_EXTRAS ${CMAKE_CURRENT_SOURCE_DIR}/python/module/module.cpp)
  set_target_properties(cradle_module PROPERTIES OUTPUT_NAME _live CXX_VISIBILITY_PRESET hidden
                                                 VISIBILITY_INLINES_HIDDEN ON UNITY_BUILD OFF
                                                 CRADLE_PYTHON_VERSION ${Python_VERSION})
  target_compile_options(cradle_module PRIVATE $<$<CONFIG:Release>:-O2>)
  include_root(tools/python _root)
  target_include_directories(cradle_module PRIVATE ${_root})
  target_link_libraries(cradle_module PRIVATE cradle_tools_store cradle_build)
endif()
