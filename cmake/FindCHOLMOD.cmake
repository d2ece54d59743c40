# SPDX-License-Identifier: Zlib
# Finds CHOLMOD of SuiteSparse 5.12 or later, which older distributions ship without a CMake configuration.
#   SuiteSparse::CHOLMOD   imported target
#   CHOLMOD_VERSION        the library's own version (3.0.14 in SuiteSparse 5.12)
find_path(CHOLMOD_INCLUDE_DIR NAMES cholmod.h PATH_SUFFIXES suitesparse)
find_library(CHOLMOD_LIBRARY NAMES cholmod)
mark_as_advanced(CHOLMOD_INCLUDE_DIR CHOLMOD_LIBRARY)

if(CHOLMOD_INCLUDE_DIR AND EXISTS "${CHOLMOD_INCLUDE_DIR}/cholmod_core.h")
    file(STRINGS "${CHOLMOD_INCLUDE_DIR}/cholmod_core.h" _lines
        REGEX "#define CHOLMOD_(MAIN|SUB|SUBSUB)_VERSION +[0-9]+")
    string(REGEX REPLACE "[^0-9;]+" "" CHOLMOD_VERSION "${_lines}")
    string(REPLACE ";" "." CHOLMOD_VERSION "${CHOLMOD_VERSION}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(CHOLMOD
    REQUIRED_VARS CHOLMOD_LIBRARY CHOLMOD_INCLUDE_DIR VERSION_VAR CHOLMOD_VERSION
    REASON_FAILURE_MESSAGE "install libsuitesparse-dev, or configure with -DBULLETFEM_WITH_CHOLMOD=OFF")

if(CHOLMOD_FOUND AND NOT TARGET SuiteSparse::CHOLMOD)
    add_library(SuiteSparse::CHOLMOD UNKNOWN IMPORTED)
    set_target_properties(SuiteSparse::CHOLMOD PROPERTIES
        IMPORTED_LOCATION "${CHOLMOD_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${CHOLMOD_INCLUDE_DIR}")
endif()
