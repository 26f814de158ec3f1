# cradle::mpfr: MPFR with GMP, where both are there. Read by the build and, installed, by the package config, so that
# they are found anew wherever Cradle is used, in the system's folders or in those that the environment names.
find_library(CRADLE_MPFR_LIBRARY mpfr HINTS ENV LIBRARY_PATH)
find_library(CRADLE_GMP_LIBRARY gmp HINTS ENV LIBRARY_PATH)
find_path(CRADLE_MPFR_INCLUDE mpfr.h HINTS ENV CPATH)
find_path(CRADLE_GMP_INCLUDE gmp.h HINTS ENV CPATH)
mark_as_advanced(CRADLE_MPFR_LIBRARY CRADLE_GMP_LIBRARY CRADLE_MPFR_INCLUDE CRADLE_GMP_INCLUDE)
if(CRADLE_MPFR_LIBRARY AND CRADLE_GMP_LIBRARY AND CRADLE_MPFR_INCLUDE AND CRADLE_GMP_INCLUDE
   AND NOT TARGET cradle::mpfr)
  add_library(cradle::mpfr INTERFACE IMPORTED)
  target_include_directories(cradle::mpfr INTERFACE ${CRADLE_MPFR_INCLUDE} ${CRADLE_GMP_INCLUDE})
  target_link_libraries(cradle::mpfr INTERFACE ${CRADLE_MPFR_LIBRARY} ${CRADLE_GMP_LIBRARY})
endif()
