# SPDX-License-Identifier: Apache-2.0
# Python tests as ctest entries, run by the pinned environment that script/bootstrap makes.

set(METAMER_PYTHON "${PROJECT_SOURCE_DIR}/build/venv/bin/python" CACHE FILEPATH
  "Python with the packages of script/requirements.txt")

# metamer_python_test(<name> SCRIPT <file> [ARGS ...] [LABELS ...] [TIMEOUT seconds] [NO_SANITIZERS] [MODULE])
# A script that exits 0 where it passes (unittest, or a plain program). It finds the build's programs in $METAMER_BIN,
# its libraries in $METAMER_LIB and the measured tables in $METAMER_DATA. Exit code 77
# means skipped. NO_SANITIZERS: leave it out of sanitizer builds (it loads a library into a plain Python, or takes
# its time and checks nothing of the C++ that others do not). MODULE: it imports the package metamer, and is left out
# where that is not built. ctest runs several at a time: NumPy's own threads would get in each other's way. They begin
# before GoogleTest's short suites, so that no processor is left idle beside the last long one.
function(metamer_python_test name)
  cmake_parse_arguments(arg "NO_SANITIZERS;MODULE" "SCRIPT;TIMEOUT" "ARGS;LABELS" ${ARGN})
  if((arg_NO_SANITIZERS AND METAMER_SANITIZERS) OR (arg_MODULE AND NOT METAMER_PYTHON_MODULE))
    return()
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 900)
  endif()
  get_filename_component(script "${arg_SCRIPT}" ABSOLUTE)
  add_test(NAME ${name} COMMAND "${METAMER_PYTHON}" -B "${script}" ${arg_ARGS}
    WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
  set_tests_properties(${name} PROPERTIES
    TIMEOUT ${arg_TIMEOUT}
    COST 10
    LABELS "python;${arg_LABELS}"
    SKIP_RETURN_CODE 77
    ENVIRONMENT "METAMER_DATA=${PROJECT_SOURCE_DIR}/data;METAMER_BIN=${CMAKE_RUNTIME_OUTPUT_DIRECTORY};METAMER_LIB=${CMAKE_LIBRARY_OUTPUT_DIRECTORY};MPLBACKEND=Agg;OPENBLAS_NUM_THREADS=1")
  if(arg_MODULE)
    set_property(TEST ${name} APPEND PROPERTY ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python")
  endif()
endfunction()
