# Headers that nearly every file parses, compiled once for all modules and once for all tests: parsing them took most of a
# build's time. No file may rely on it: CMAKE_DISABLE_PRECOMPILE_HEADERS, as the preset `dev` has it, builds without.
# Compiler caches work with it, for any checkout: ccache needs the sloppiness that Options.cmake sets, and -fpch-preprocess.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)
endif()
set(OSCULATE_PRECOMPILED
    <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <iterator>
    <limits> <map> <memory> <numeric> <optional> <set> <span> <sstream> <stdexcept> <string> <string_view> <utility>
    <variant> <vector>)
# osculate_precompiled(NAME HEADERS headers... LINKS libraries...): a target with nothing but precompiled headers, for others to take by
# target_precompile_headers(... REUSE_FROM NAME)
function(osculate_precompiled name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINKS" ${ARGN})
  set(source ${PROJECT_BINARY_DIR}/${name}.cpp)
  if(NOT EXISTS ${source})
    file(WRITE ${source} "// nothing: ${name} is for its precompiled headers\n")
  endif()
  add_library(${name} OBJECT ${source})
  target_compile_features(${name} PRIVATE cxx_std_20)
  target_link_libraries(${name} PRIVATE ${ARG_LINKS})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()
