# SPDX-License-Identifier: Zlib
# Provides hwy::hwy (Highway) according to BULLETFEM_VECTORS; unless that is dynamic, as a header-only target without a
# library to link or install. BULLETFEM_HWY is the target that the libraries link.
set_property(CACHE BULLETFEM_VECTORS PROPERTY STRINGS dynamic static scalar)
if(NOT BULLETFEM_VECTORS MATCHES "^(dynamic|static|scalar)$")
    message(FATAL_ERROR "BULLETFEM_VECTORS is ${BULLETFEM_VECTORS}: it must be dynamic, static or scalar")
endif()
if(BULLETFEM_VECTORS STREQUAL dynamic)
    find_package(hwy REQUIRED)
    set(BULLETFEM_HWY hwy::hwy)
    return()
endif()

find_path(BULLETFEM_HWY_INCLUDE_DIR NAMES hwy/highway.h REQUIRED)
mark_as_advanced(BULLETFEM_HWY_INCLUDE_DIR)
string(TOUPPER "${BULLETFEM_VECTORS}" _vectors)
add_library(hwy::hwy INTERFACE IMPORTED GLOBAL)
set_target_properties(hwy::hwy PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${BULLETFEM_HWY_INCLUDE_DIR}"
    INTERFACE_COMPILE_DEFINITIONS HWY_COMPILE_ONLY_${_vectors})
set(BULLETFEM_HWY "$<BUILD_INTERFACE:hwy::hwy>")
