# SPDX-License-Identifier: Apache-2.0
# Run after a test program is linked: writes a ctest entry for each of its suites, so that what a suite builds once, in
# one process, serves all of its cases.
#   cmake -DPROGRAM=<file> -DNAME=<name> -DFOLDER=<working folder> -DLABELS=<list> -DLONG=<suites> -DOUTPUT=<file>
#     -P DiscoverSuites.cmake
# A suite of LONG is not labelled quick, and is started before others; a name there without its suite is an error.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND "${PROGRAM}" --gtest_list_tests WORKING_DIRECTORY "${FOLDER}"
  OUTPUT_VARIABLE listing RESULT_VARIABLE status TIMEOUT 60)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} does not list its tests: ${status}\n${listing}")
endif()

string(REGEX REPLACE "[][;]" "_" listing "${listing}")
# Suites stand at the start of a line ("Suite." or "Every/Suite.  # GetParam() = ..."), cases are indented.
string(REGEX MATCHALL "(^|\n)[^ \n]+\\.([ ][^\n]*)?" lines "${listing}")
set(text "")
set(suites "")
foreach(line IN LISTS lines)
  string(REGEX REPLACE "^\n?([^ \n]+)\\..*" "\\1" suite "${line}")
  list(APPEND suites "${suite}")
endforeach()
list(REMOVE_DUPLICATES suites)
if(NOT suites)
  message(FATAL_ERROR "${PROGRAM} has no tests")
endif()
foreach(suite IN LISTS LONG)
  if(NOT suite IN_LIST suites)
    message(FATAL_ERROR "${NAME}: no suite ${suite}, which is named as a long one; there are ${suites}")
  endif()
endforeach()
foreach(suite IN LISTS suites)
  set(labels ${LABELS})
  set(cost 1)
  if(suite IN_LIST LONG)
    set(cost 100)
  else()
    list(APPEND labels quick)
  endif()
  string(APPEND text
    "add_test([=[${NAME}.${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
    "set_tests_properties([=[${NAME}.${suite}]=] PROPERTIES WORKING_DIRECTORY [=[${FOLDER}]=] TIMEOUT 900"
    " COST ${cost} LABELS [=[${labels}]=])\n")
endforeach()
file(WRITE "${OUTPUT}" "${text}")
