# SuiteSparse::cholmod and SuiteSparse::umfpack: SuiteSparse 5 in Debian ships no CMake package.
foreach(library cholmod umfpack)
  find_library(SUITESPARSE_${library} ${library} REQUIRED)
  find_path(SUITESPARSE_INCLUDE ${library}.h PATH_SUFFIXES suitesparse REQUIRED)
  if(NOT TARGET SuiteSparse::${library})
    add_library(SuiteSparse::${library} UNKNOWN IMPORTED)
    set_target_properties(SuiteSparse::${library} PROPERTIES IMPORTED_LOCATION ${SUITESPARSE_${library}}
                                                             INTERFACE_INCLUDE_DIRECTORIES ${SUITESPARSE_INCLUDE})
  endif()
endforeach()
