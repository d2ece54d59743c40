# SPDX-License-Identifier: Zlib
# cmake -DCASE=<case> -DMESSAGE=<regular expression> -DPREFIX=<installation> -DBINARY=<folder> -DGENERATOR=<generator>
#   -P mismatch.cmake
# Configures and builds a case of the adjacent CMakeLists.txt. It must work without MESSAGE, and fail with a given one.
file(REMOVE_RECURSE "${BINARY}")
execute_process(
    COMMAND ${CMAKE_COMMAND} -S "${CMAKE_CURRENT_LIST_DIR}" -B "${BINARY}" -G "${GENERATOR}" -DCASE=${CASE}
        -DCMAKE_PREFIX_PATH=${PREFIX} -DCMAKE_BUILD_TYPE=Release
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result EQUAL 0)
    execute_process(COMMAND ${CMAKE_COMMAND} --build "${BINARY}"
        RESULT_VARIABLE result OUTPUT_VARIABLE built ERROR_VARIABLE built)
    string(APPEND output "${built}")
endif()

if(NOT MESSAGE)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${CASE} failed:\n${output}")
    endif()
elseif(result EQUAL 0)
    message(FATAL_ERROR "${CASE} was built, although the precisions differ")
else()
    string(REGEX REPLACE "[ \n]+" " " line "${output}") # CMake wraps its messages
    if(NOT line MATCHES "${MESSAGE}")
        message(FATAL_ERROR "${CASE} failed, but without \"${MESSAGE}\":\n${output}")
    endif()
endif()
