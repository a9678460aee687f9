# Debian 12 packages; scripts/dependencies.txt names them, scripts/dependencies_bench.txt those of the benchmarks.
set(THREADS_PREFER_PTHREAD_FLAG ON)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(yaml-cpp 0.7 REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(SUNDIALS 6.4 REQUIRED COMPONENTS kinsol nvecserial)
if(OSCULATE_BENCH)
  find_package(benchmark REQUIRED)
endif()
set(OSCULATE_VTK_READERS VTK::CommonCore VTK::CommonDataModel VTK::IOXML)
set(OSCULATE_VTK_WRITERS VTK::CommonCore VTK::CommonDataModel VTK::IOXML)
find_package(VTK 9.1 REQUIRED COMPONENTS CommonCore CommonDataModel IOXML)

# SuiteSparse 5 in Debian ships no CMake package.
foreach(library cholmod umfpack)
  find_library(SUITESPARSE_${library} ${library} REQUIRED)
  add_library(SuiteSparse::${library} UNKNOWN IMPORTED)
  find_path(SUITESPARSE_INCLUDE ${library}.h PATH_SUFFIXES suitesparse REQUIRED)
  set_target_properties(SuiteSparse::${library} PROPERTIES IMPORTED_LOCATION ${SUITESPARSE_${library}}
                                                           INTERFACE_INCLUDE_DIRECTORIES ${SUITESPARSE_INCLUDE})
endforeach()
