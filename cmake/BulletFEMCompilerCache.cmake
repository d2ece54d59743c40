# SPDX-License-Identifier: Zlib
# Compiles through ccache according to BULLETFEM_CCACHE; a launcher set by the user or a parent project is kept.
set_property(CACHE BULLETFEM_CCACHE PROPERTY STRINGS AUTO ON OFF)
if(NOT BULLETFEM_CCACHE MATCHES "^(AUTO|ON|OFF)$")
    message(FATAL_ERROR "BULLETFEM_CCACHE is ${BULLETFEM_CCACHE}: it must be AUTO, ON or OFF")
endif()
if(BULLETFEM_CCACHE STREQUAL OFF OR CMAKE_CXX_COMPILER_LAUNCHER OR NOT PROJECT_IS_TOP_LEVEL)
    return()
endif()

find_program(BULLETFEM_CCACHE_PROGRAM ccache)
mark_as_advanced(BULLETFEM_CCACHE_PROGRAM)
if(BULLETFEM_CCACHE_PROGRAM)
    # Required by ccache for precompiled headers.
    set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env
        CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime "${BULLETFEM_CCACHE_PROGRAM}")
elseif(BULLETFEM_CCACHE STREQUAL ON)
    message(FATAL_ERROR "BULLETFEM_CCACHE is ON, but there is no ccache: install ccache, or say AUTO")
endif()
