# SPDX-License-Identifier: Zlib
# Fails if a shared library exports a name that is not one of BulletFEM's, or one that only its own sources call.
#   NM           binutils
#   LIBRARIES    the shared libraries
#   EXPECTED     names that one of them must export, as a check of the test itself
#   HIDDEN       names that none of them may export
set(_all "")
foreach(_library IN LISTS LIBRARIES)
    execute_process(COMMAND "${NM}" --dynamic --demangle --defined-only --format=posix "${_library}"
        OUTPUT_VARIABLE _names COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX REPLACE "\n$" "" _names "${_names}")
    string(REPLACE ";" "," _names "${_names}")
    string(REPLACE "\n" ";" _names "${_names}")
    set(_foreign "${_names}")
    set(_kind "(vtable for |typeinfo for |typeinfo name for |non-virtual thunk to |bullet_fem::[A-Za-z0-9]+ )?")
    list(FILTER _foreign EXCLUDE REGEX "^${_kind}(bullet_fem::|btFem|bulletfem_error__)")
    if(_foreign)
        list(LENGTH _foreign _count)
        list(GET _foreign 0 _first)
        message(SEND_ERROR "${_library} exports ${_count} foreign names, the first is ${_first}")
    endif()
    list(LENGTH _names _count)
    message("${_library}: ${_count} names")
    string(APPEND _all "${_names};")
endforeach()
foreach(_name IN LISTS EXPECTED)
    if(NOT _all MATCHES "${_name}")
        message(SEND_ERROR "none of ${LIBRARIES} exports ${_name}")
    endif()
endforeach()
foreach(_name IN LISTS HIDDEN)
    if(_all MATCHES "${_name}")
        message(SEND_ERROR "${_name} is exported: it must be hidden")
    endif()
endforeach()
