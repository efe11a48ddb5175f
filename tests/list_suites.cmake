# Writes a file for ctest with one test per suite of a gtest program (rcme_discover_suites in CMakeLists.txt):
#   cmake -DPROGRAM=... -DPREFIX=... -DFILE=... -P list_suites.cmake
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listing RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests: ${result}\n${listing}")
endif()
# A suite's line begins at the margin and ends with a dot, before "  # TypeParam = ..."; its tests follow indented.
string(REGEX MATCHALL "(^|\n)[^ \n]+[.]" suites "${listing}")
set(tests)
foreach(suite ${suites})
  string(REGEX REPLACE "^\n|[.]$" "" suite "${suite}")
  string(APPEND tests "add_test([=[${PREFIX}${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
                      "set_tests_properties([=[${PREFIX}${suite}]=] PROPERTIES ENVIRONMENT GLOG_minloglevel=3)\n")
endforeach()
file(WRITE ${FILE} "${tests}")
