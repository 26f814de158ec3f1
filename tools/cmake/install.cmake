# cmake --install: headers, the package config for find_package(cradle), and the program.
include(CMakePackageConfigHelpers)

install(TARGETS cradle_options cradle_core cradle_ensemble cradle_precision cradle EXPORT cradle-targets)
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
