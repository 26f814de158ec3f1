# Libraries that Cradle's headers need, as targets: Boost::headers, TBB::tbb and, where it is there, cradle::mpfr. What
# is required here cradle-config.cmake.in requires of those who use an installation.
if(POLICY CMP0167)
  cmake_policy(SET CMP0167 NEW)  # Boost's own package config
endif()
find_package(Boost 1.74 REQUIRED)
find_package(TBB 2021 REQUIRED)
find_package(Threads REQUIRED)
include(${CMAKE_CURRENT_LIST_DIR}/mpfr.cmake)
set(CRADLE_NEEDS_MPFR FALSE)
if(TARGET cradle::mpfr)
  set(CRADLE_NEEDS_MPFR TRUE)
endif()
