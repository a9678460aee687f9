# cmake -DBUILD= -DSOURCE= -DFOLDER= -DGENERATOR= -DCXX= -DFLAGS= -DLAUNCHER= -DPYTHON= -P check.cmake: installs the build, moves the tree
# elsewhere, runs the program and the Python module there, builds the consumer against it and runs that.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE faults)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nended with ${code}\n${said}${faults}")
  endif()
  set(said "${said}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${FOLDER})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${FOLDER}/first)
file(RENAME ${FOLDER}/first ${FOLDER}/moved)
set(moved ${FOLDER}/moved)

# the shipped data are those of the moved tree: this template is nowhere else
file(READ ${moved}/share/osculate/output_templates/minimal.yaml template)
file(WRITE ${moved}/share/osculate/output_templates/planted.yaml "${template}")
run(${moved}/bin/osculate run ${SOURCE}/tests/scenes/press.yaml --set output.template=planted
    --set solver.linear_solver=multigrid -o ${FOLDER}/run --quiet)
if(PYTHON)
  run(${CMAKE_COMMAND} -E env PYTHONPATH=${moved}/lib/python3/dist-packages ${PYTHON} -B -c
      "import osculate; osculate.Run('${SOURCE}/tests/scenes/press.yaml', {'output.template': 'planted', 'solver.linear_solver': 'multigrid'}).run()")
endif()
function(build source folder)
  run(${CMAKE_COMMAND} -S ${source} -B ${folder} -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${moved}
      -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_FLAGS=${FLAGS}
      -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_BUILD_TYPE= ${ARGN})
  run(${CMAKE_COMMAND} --build ${folder})
endfunction()

# contact geometry needs neither solvers nor libraries for files, whose packages cannot be found here
build(${SOURCE}/tests/consumer/geometry ${FOLDER}/geometry -DCMAKE_DISABLE_FIND_PACKAGE_SUNDIALS=ON
      -DCMAKE_DISABLE_FIND_PACKAGE_yaml-cpp=ON -DCMAKE_DISABLE_FIND_PACKAGE_muparser=ON -DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON)
run(${FOLDER}/geometry/geometry)

build(${SOURCE}/tests/consumer ${FOLDER}/consumer)
run(${FOLDER}/consumer/consumer ${SOURCE}/tests/scenes/press.yaml)
if(NOT said MATCHES "time 1 s: force [^ ]+ [^ ]+ 1\\.00000[0-9]e\\+05 N")
  message(FATAL_ERROR "expected a force of 1e5 N along z at the end, as the block is pressed by it; found\n${said}")
endif()
file(REMOVE_RECURSE ${FOLDER})
