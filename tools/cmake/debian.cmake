# `cpack -G DEB` in the build tree makes cradle_VERSION_ARCHITECTURE.deb of what `cmake --install` installs. Its
# dependencies are those of the libraries that the program was linked with, so it is for the release of Debian it was
# built on; with the preset `portable` it is for every processor. The Python package and zsh's completion are where
# Debian's find them. The same file is the script that cpack runs between installing and packing.

if(CPACK_TEMPORARY_INSTALL_DIRECTORY)
  set(_usr ${CPACK_TEMPORARY_INSTALL_DIRECTORY}${CPACK_PACKAGING_INSTALL_PREFIX})
  set(_packages ${_usr}/lib/python3/dist-packages)
  file(MAKE_DIRECTORY ${_packages})
  file(RENAME ${_usr}/${CPACK_CRADLE_PYTHON_DIR}/cradle ${_packages}/cradle)
  file(REMOVE_RECURSE ${_usr}/${CPACK_CRADLE_PYTHON_DIR})
  file(RENAME ${_usr}/share/zsh/site-functions ${_usr}/share/zsh/vendor-completions)
  return()
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "Cradle developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_FILE})
set(CPACK_CRADLE_PYTHON_DIR ${CRADLE_PYTHON_DIR})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS python3)
if(TARGET cradle_module)  # for one version of Python
  get_target_property(_python cradle_module CRADLE_PYTHON_VERSION)
  string(REGEX MATCH "^([0-9]+)[.]([0-9]+)" _python "${_python}")
  math(EXPR _next "${CMAKE_MATCH_2} + 1")
  set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= ${_python}), python3 (<< ${CMAKE_MATCH_1}.${_next})")
endif()
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-h5py, python3-matplotlib, python3-numpy")
# For programs in C++, for numbers with all their digits, and for tables.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "g++, cmake, libboost-dev, libtbb-dev, libmpfr-dev, libgmp-dev, python3-mpmath, python3-pandas, python3-xarray")
if(CRADLE_NEEDS_HIGHWAY)
  string(APPEND CPACK_DEBIAN_PACKAGE_SUGGESTS ", libhwy-dev")
endif()
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/debian/postinst
                                       ${CMAKE_CURRENT_LIST_DIR}/debian/prerm)
include(CPack)
