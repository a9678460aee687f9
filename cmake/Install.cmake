# The install tree: bin, lib (with lib/cmake/osculate), include/osculate, share/osculate, lib/python3/dist-packages. It may be
# moved as a whole: modules are looked for, and data found, from where program and libraries are.
include(CMakePackageConfigHelpers)

# osculate::osculate is everything
add_library(osculate_osculate INTERFACE)
target_link_libraries(osculate_osculate INTERFACE osculate_app)
add_library(osculate::osculate ALIAS osculate_osculate)
set_target_properties(osculate_osculate PROPERTIES EXPORT_NAME osculate)

get_property(modules GLOBAL PROPERTY OSCULATE_MODULES)
install(TARGETS osculate COMPONENT program)
install(TARGETS ${modules} osculate_osculate EXPORT osculate COMPONENT development)
foreach(loaded osculate_multigrid osculate_vtk osculate_gmsh) # at run time, by scenes that ask for them
  if(TARGET ${loaded})
    install(TARGETS ${loaded} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT program)
  endif()
endforeach()
install(DIRECTORY include/osculate DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(DIRECTORY output_templates configs DESTINATION ${CMAKE_INSTALL_DATADIR}/osculate COMPONENT program)
install(FILES scripts/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME osculate COMPONENT program)
install(FILES LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DATADIR}/osculate COMPONENT program)

# data_folder() finds share/osculate by these
set(OSCULATE_PYTHON_DIR lib/python3/dist-packages) # where Debian's Python looks below its prefix
set(prefix /p)
foreach(from PROGRAM:${CMAKE_INSTALL_BINDIR} LIBRARY:${CMAKE_INSTALL_LIBDIR} PYTHON:${OSCULATE_PYTHON_DIR})
  string(REGEX MATCH "^([A-Z]+):(.*)$" matched ${from})
  file(RELATIVE_PATH path ${prefix}/${CMAKE_MATCH_2} ${prefix}/${CMAKE_INSTALL_DATADIR}/osculate)
  list(APPEND definitions OSCULATE_DATA_FROM_${CMAKE_MATCH_1}="${path}")
endforeach()
set_source_files_properties(src/core/data_folder.cpp PROPERTIES COMPILE_DEFINITIONS
  "${definitions};OSCULATE_SOURCE_TREE=\"${PROJECT_SOURCE_DIR}\";OSCULATE_INSTALLED_DATA=\"${CMAKE_INSTALL_FULL_DATADIR}/osculate\"")

if(TARGET osculate_python)
  file(RELATIVE_PATH libraries ${prefix}/${OSCULATE_PYTHON_DIR} ${prefix}/${CMAKE_INSTALL_LIBDIR})
  set_target_properties(osculate_python PROPERTIES INSTALL_RPATH $ORIGIN/${libraries})
  install(TARGETS osculate_python LIBRARY DESTINATION ${OSCULATE_PYTHON_DIR} COMPONENT python)
endif()

# find_package(osculate)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/osculate)
set(OSCULATE_VTK_COMPONENTS ${OSCULATE_VTK_WRITERS})
list(TRANSFORM OSCULATE_VTK_COMPONENTS REPLACE "^VTK::" "")
list(REMOVE_DUPLICATES OSCULATE_VTK_COMPONENTS)
list(JOIN OSCULATE_VTK_COMPONENTS " " OSCULATE_VTK_COMPONENTS)
install(EXPORT osculate NAMESPACE osculate:: FILE osculate-targets.cmake DESTINATION ${package_dir} COMPONENT development)
configure_package_config_file(cmake/osculate-config.cmake.in ${PROJECT_BINARY_DIR}/osculate-config.cmake
                              INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/osculate-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/osculate-config.cmake ${PROJECT_BINARY_DIR}/osculate-config-version.cmake
              cmake/SuiteSparse.cmake DESTINATION ${package_dir} COMPONENT development)
