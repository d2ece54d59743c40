# SPDX-License-Identifier: Zlib
# Fails if installed files, or a program linked with them, depend on a part of SuiteSparse other than AMD and its
# configuration, or on libraries that only those parts need: Debian's CHOLMOD, UMFPACK and SPQR are under the GPL.
#   READELF, NM      binutils
#   PREFIX           the installation
#   PROGRAMS         programs that were linked with it
#   EXPECTED         a dependency that one of the programs must have, as a check of the test itself; or empty
set(_forbidden "lib(cholmod|umfpack|spqr|camd|ccolamd|colamd|klu|blas|lapack|openblas)[^a-z]")
set(_symbols "(^|[ \n])_?(cholmod_|umfpack_|SuiteSparseQR)[A-Za-z0-9_]*")

file(GLOB_RECURSE _files "${PREFIX}/*")
set(_looked_at 0)
set(_needed_by_all "")
foreach(_file IN LISTS _files PROGRAMS)
    if(_file MATCHES "[.](h|hpp)$")
        continue()
    elseif(_file MATCHES "[.]cmake$")
        file(READ "${_file}" _text)
        if(NOT _file MATCHES "/FindSuiteSparse[.]cmake$" AND _text MATCHES "[Cc][Hh][Oo][Ll][Mm][Oo][Dd]")
            message(SEND_ERROR "${_file} names CHOLMOD")
        endif()
    elseif(_file MATCHES "[.]a$")
        execute_process(COMMAND "${NM}" -u "${_file}" OUTPUT_VARIABLE _undefined ERROR_QUIET RESULT_VARIABLE _failed)
        if(NOT _failed AND _undefined MATCHES "${_symbols}")
            message(SEND_ERROR "${_file} calls ${CMAKE_MATCH_0}")
        endif()
        math(EXPR _looked_at "${_looked_at} + 1")
    else()
        execute_process(COMMAND "${READELF}" -d "${_file}" OUTPUT_VARIABLE _dynamic ERROR_QUIET RESULT_VARIABLE _failed)
        if(NOT _failed AND _dynamic MATCHES "NEEDED")
            string(REGEX MATCHALL "Shared library: .[^]]+" _needed "${_dynamic}")
            if(_dynamic MATCHES "${_forbidden}")
                message(SEND_ERROR "${_file} depends on ${CMAKE_MATCH_0}")
            endif()
            string(APPEND _needed_by_all "${_needed}")
            math(EXPR _looked_at "${_looked_at} + 1")
        endif()
    endif()
endforeach()

if(_looked_at LESS 5)
    message(SEND_ERROR "only ${_looked_at} libraries and programs were found in ${PREFIX} and ${PROGRAMS}")
endif()
if(EXPECTED AND NOT _needed_by_all MATCHES "${EXPECTED}")
    message(SEND_ERROR "nothing depends on ${EXPECTED}: ${_needed_by_all}")
endif()
message("${_looked_at} libraries and programs were looked at")
