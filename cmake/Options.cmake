# Compiler settings shared by every target of Osculate, and by none of its dependencies.
add_library(osculate_options INTERFACE)
target_compile_options(osculate_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                                                 # GCC 12 reports false overlaps and sizes inside std::string
                                                 -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds)
if(OSCULATE_WARNINGS_AS_ERRORS)
  target_compile_options(osculate_options INTERFACE -Werror)
endif()
if(OSCULATE_SANITIZE)
  # Every finding ends the program, so that a test fails by it. Checks of every reference for null and alignment double the
  # compile time; a null access ends the program without them, and Eigen asserts its alignment.
  add_compile_options(-fsanitize=${OSCULATE_SANITIZE} -fno-sanitize=null,alignment -fno-sanitize-recover=all
                      -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${OSCULATE_SANITIZE})
endif()
if(OSCULATE_COVERAGE)
  # counters that threads share are counted atomically; files are found from wherever a test runs
  add_compile_options(--coverage -fprofile-abs-path -fprofile-update=atomic)
  add_link_options(--coverage)
endif()
# Results must not depend on the machine the binary was built on: no -march=native, no contraction of a*b+c.
add_compile_options(-ffp-contract=off)
# Where there is memory for it, GCC collects garbage a few times a file instead of dozens: a tenth of the time for a fifth more memory.
cmake_host_system_information(RESULT OSCULATE_MEMORY QUERY TOTAL_PHYSICAL_MEMORY) # MiB
cmake_host_system_information(RESULT OSCULATE_PROCESSORS QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR OSCULATE_MEMORY_OF_A_COMPILER "${OSCULATE_MEMORY} / (${OSCULATE_PROCESSORS} + 2)")
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND OSCULATE_MEMORY_OF_A_COMPILER GREATER 4000)
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:--param=ggc-min-heapsize=2000000>)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  # precompiled headers are kept, too
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()
