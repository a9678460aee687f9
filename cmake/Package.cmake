# Debian packages, by `cpack -G DEB` in the build folder or scripts/package: osculate (the program with what it loads and its data),
# python3-osculate (the module), libosculate-dev (headers and static libraries).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME osculate)
set(CPACK_PACKAGE_VENDOR Osculate)
set(CPACK_PACKAGE_CONTACT "The Osculate developers <osculate@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program python development)
if(NOT TARGET osculate_python)
  list(REMOVE_ITEM CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME osculate)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS gnuplot-nox) # plots
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
  "A YAML scene, one command, a VTK series for ParaView and a report. The terms of the libraries hold for the program as well; see NOTICE in /usr/share/osculate.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-osculate)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3, python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Osculate as a Python module.")
set(CPACK_COMPONENT_PYTHON_DEPENDS program)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libosculate-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Osculate's headers and static libraries, for find_package(osculate).")
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS program)
# what osculate-config.cmake looks for
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libeigen3-dev, libsundials-dev, libsuitesparse-dev, libmetis-dev, libopenblas-dev, libvtk9-dev, libyaml-cpp-dev, libmuparser-dev, libfmt-dev, libpng-dev, zlib1g-dev, libboost-dev")
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
include(CPack)
