# SPDX-License-Identifier: Zlib
# Finds METIS 5, which distributions ship without a CMake configuration.
#   METIS::METIS    imported target
#   METIS_VERSION   such as 5.1.0
find_path(METIS_INCLUDE_DIR NAMES metis.h)
find_library(METIS_LIBRARY NAMES metis)
mark_as_advanced(METIS_INCLUDE_DIR METIS_LIBRARY)

if(METIS_INCLUDE_DIR AND EXISTS "${METIS_INCLUDE_DIR}/metis.h")
    file(STRINGS "${METIS_INCLUDE_DIR}/metis.h" _lines REGEX "#define METIS_VER_(MAJOR|MINOR|SUBMINOR) +[0-9]+")
    string(REGEX REPLACE "[^0-9;]+" "" METIS_VERSION "${_lines}")
    string(REPLACE ";" "." METIS_VERSION "${METIS_VERSION}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(METIS
    REQUIRED_VARS METIS_LIBRARY METIS_INCLUDE_DIR VERSION_VAR METIS_VERSION
    REASON_FAILURE_MESSAGE "install libmetis-dev, or configure with -DBULLETFEM_WITH_METIS=OFF")

if(METIS_FOUND AND NOT TARGET METIS::METIS)
    add_library(METIS::METIS UNKNOWN IMPORTED)
    set_target_properties(METIS::METIS PROPERTIES
        IMPORTED_LOCATION "${METIS_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${METIS_INCLUDE_DIR}")
endif()
