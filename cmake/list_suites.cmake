# SPDX-License-Identifier: Zlib
# Writes OUTPUT, a file by which ctest runs each suite of the GoogleTest program PROGRAM as one test; called after the
# program is built. NAME_SUFFIX is appended to the suites' names, PROPERTIES are passed to set_tests_properties.
execute_process(COMMAND ${EMULATOR} "${PROGRAM}" --gtest_list_tests
    OUTPUT_VARIABLE _list TIMEOUT 60 COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n[A-Za-z0-9_/]+[.][ \n]" _suites "\n${_list}")
list(TRANSFORM _suites REPLACE "[ \n.]" "")

set(_tests "")
foreach(_suite IN LISTS _suites)
    string(APPEND _tests "add_test([=[${_suite}${NAME_SUFFIX}]=] ${EMULATOR} [=[${PROGRAM}]=] [=[--gtest_filter=${_suite}.*]=])\n"
        "set_tests_properties([=[${_suite}${NAME_SUFFIX}]=] PROPERTIES ${PROPERTIES})\n")
endforeach()
file(WRITE "${OUTPUT}" "${_tests}")
