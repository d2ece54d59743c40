# SPDX-License-Identifier: Zlib
# Finds parts of SuiteSparse, requested as components; distributions ship it without a CMake configuration.
#   component AMD      SuiteSparse::AMD, BSD licence: minimum-degree orders; with SuiteSparse_config
#   component CHOLMOD  SuiteSparse::CHOLMOD, GPL in Debian's binary: only for targets that are never installed
#   SuiteSparse_VERSION  such as 5.12.0
find_path(SuiteSparse_INCLUDE_DIR NAMES SuiteSparse_config.h PATH_SUFFIXES suitesparse)
find_library(SuiteSparse_config_LIBRARY NAMES suitesparseconfig)
mark_as_advanced(SuiteSparse_INCLUDE_DIR SuiteSparse_config_LIBRARY)

if(SuiteSparse_INCLUDE_DIR AND EXISTS "${SuiteSparse_INCLUDE_DIR}/SuiteSparse_config.h")
    file(STRINGS "${SuiteSparse_INCLUDE_DIR}/SuiteSparse_config.h" _lines
        REGEX "#define SUITESPARSE_(MAIN|SUB|SUBSUB)_VERSION +[0-9]+")
    string(REGEX REPLACE "[^0-9;]+" "" SuiteSparse_VERSION "${_lines}")
    string(REPLACE ";" "." SuiteSparse_VERSION "${SuiteSparse_VERSION}")
endif()

foreach(_part IN LISTS SuiteSparse_FIND_COMPONENTS)
    string(TOLOWER "${_part}" _name)
    find_library(SuiteSparse_${_part}_LIBRARY NAMES ${_name})
    mark_as_advanced(SuiteSparse_${_part}_LIBRARY)
    if(SuiteSparse_${_part}_LIBRARY AND EXISTS "${SuiteSparse_INCLUDE_DIR}/${_name}.h")
        set(SuiteSparse_${_part}_FOUND TRUE)
    endif()
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SuiteSparse
    REQUIRED_VARS SuiteSparse_config_LIBRARY SuiteSparse_INCLUDE_DIR VERSION_VAR SuiteSparse_VERSION HANDLE_COMPONENTS
    REASON_FAILURE_MESSAGE "install libsuitesparse-dev, or configure with -DBULLETFEM_WITH_SUITESPARSE=OFF")

foreach(_part IN LISTS SuiteSparse_FIND_COMPONENTS)
    if(SuiteSparse_FOUND AND SuiteSparse_${_part}_FOUND AND NOT TARGET SuiteSparse::${_part})
        add_library(SuiteSparse::${_part} UNKNOWN IMPORTED)
        set_target_properties(SuiteSparse::${_part} PROPERTIES
            IMPORTED_LOCATION "${SuiteSparse_${_part}_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${SuiteSparse_INCLUDE_DIR}"
            INTERFACE_LINK_LIBRARIES "${SuiteSparse_config_LIBRARY}")
    endif()
endforeach()
