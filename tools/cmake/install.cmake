# cmake --install: headers, the package config for find_package(cradle), the documents, the program with its manual page
# and completions, the scenes, and the Python package with its module where that is built. `cpack -G DEB` packs the
# same.
include(CMakePackageConfigHelpers)

install(TARGETS cradle_options cradle_core cradle_steps cradle_ensemble cradle_precision cradle
        EXPORT cradle-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(_part core precision)
  install(DIRECTORY ${_part}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cradle/${_part} FILES_MATCHING PATTERN "*.hpp")
endforeach()
set(_package ${CMAKE_INSTALL_LIBDIR}/cmake/cradle)
install(EXPORT cradle-targets NAMESPACE cradle:: DESTINATION ${_package})
configure_package_config_file(${PROJECT_SOURCE_DIR}/tools/cmake/cradle-config.cmake.in
                              ${PROJECT_BINARY_DIR}/cradle-config.cmake INSTALL_DESTINATION ${_package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cradle-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cradle-config.cmake ${PROJECT_BINARY_DIR}/cradle-config-version.cmake
              tools/cmake/mpfr.cmake DESTINATION ${_package})

# In the folders of the tree, so that links from one to the other work.
foreach(_document README.md .github/CHANGELOG.md .github/CONTRIBUTING.md bench/README.md bench/pictures/fig2.png
                  core/README.md tests/README.md tools/README.md)
  get_filename_component(_folder ${_document} DIRECTORY)
  install(FILES ${_document} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${_folder})
endforeach()
install(DIRECTORY tools/manual DESTINATION ${CMAKE_INSTALL_DOCDIR}/tools FILES_MATCHING PATTERN "*.md"
        PATTERN site EXCLUDE PATTERN theme EXCLUDE)
install(DIRECTORY bench/results DESTINATION ${CMAKE_INSTALL_DOCDIR}/bench FILES_MATCHING PATTERN "*.md")
install(DIRECTORY tools/python/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}/tools/python)
# The pages of the folders.
file(GLOB _pages RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS core/*/README.md precision/README.md)
foreach(_page IN LISTS _pages)
  get_filename_component(_folder ${_page} DIRECTORY)
  install(FILES ${_page} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${_folder})
endforeach()

if(CRADLE_TOOLS)
  install(DIRECTORY tools/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/cradle)
  set(CRADLE_PYTHON_DIR ${CMAKE_INSTALL_DATADIR}/cradle/python
      CACHE STRING "where the Python package is installed, below the prefix: to be in PYTHONPATH")
  install(DIRECTORY tools/python/cradle DESTINATION ${CRADLE_PYTHON_DIR}
          PATTERN __pycache__ EXCLUDE)
  if(TARGET cradle_module)
    install(TARGETS cradle_module LIBRARY DESTINATION ${CRADLE_PYTHON_DIR}/cradle)
  endif()
  # What the program prints of itself.
  set(_texts ${PROJECT_BINARY_DIR}/installed_texts)
  file(MAKE_DIRECTORY ${_texts})
  foreach(_text manual=cradle.1=${CMAKE_INSTALL_MANDIR}/man1
                completion,bash=cradle=${CMAKE_INSTALL_DATADIR}/bash-completion/completions
                completion,zsh=_cradle=${CMAKE_INSTALL_DATADIR}/zsh/site-functions
                completion,fish=cradle.fish=${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
    string(REPLACE "=" ";" _text ${_text})
    list(GET _text 0 _words)
    list(GET _text 1 _file)
    list(GET _text 2 _folder)
    string(REPLACE "," " " _words ${_words})
    install(CODE "execute_process(COMMAND \"$<TARGET_FILE:cradle_cli>\" ${_words}
                                  OUTPUT_FILE \"${_texts}/${_file}\" COMMAND_ERROR_IS_FATAL ANY)")
    install(FILES ${_texts}/${_file} DESTINATION ${_folder})
  endforeach()
endif()

if(CRADLE_TOOLS AND PROJECT_IS_TOP_LEVEL)
  include(tools/cmake/debian.cmake)
endif()
