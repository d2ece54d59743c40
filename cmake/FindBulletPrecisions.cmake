# SPDX-License-Identifier: Zlib
# Finds Bullet in both precisions side by side, as Debian ships it, and makes the imported targets that CMake's own
# FindBullet does not make. The headers are the same for both; BT_USE_DOUBLE_PRECISION chooses the layout.
#   component float    Bullet::SoftBody, Bullet::Dynamics, Bullet::Collision, Bullet::LinearMath
#   component float64  Bullet::SoftBody-float64 and so on, with BT_USE_DOUBLE_PRECISION in their interface
# Each tells its precision as BULLET_PRECISION. CMake stops with an error where a target would have two of them.
find_path(BulletPrecisions_INCLUDE_DIR NAMES btBulletDynamicsCommon.h PATH_SUFFIXES bullet)
mark_as_advanced(BulletPrecisions_INCLUDE_DIR)

set(_suffix_float "")
set(_suffix_float64 "-float64")
set(_parts LinearMath BulletCollision BulletDynamics BulletSoftBody)
foreach(_precision float float64)
    set(BulletPrecisions_${_precision}_FOUND TRUE)
    foreach(_part IN LISTS _parts)
        find_library(BulletPrecisions_${_part}_${_precision}_LIBRARY NAMES ${_part}${_suffix_${_precision}})
        mark_as_advanced(BulletPrecisions_${_part}_${_precision}_LIBRARY)
        if(NOT BulletPrecisions_${_part}_${_precision}_LIBRARY)
            set(BulletPrecisions_${_precision}_FOUND FALSE)
        endif()
    endforeach()
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BulletPrecisions REQUIRED_VARS BulletPrecisions_INCLUDE_DIR HANDLE_COMPONENTS
    REASON_FAILURE_MESSAGE "install libbullet-dev")

foreach(_precision float float64)
    set(_suffix "${_suffix_${_precision}}")
    if(NOT BulletPrecisions_FOUND OR NOT BulletPrecisions_${_precision}_FOUND OR TARGET Bullet::SoftBody${_suffix})
        continue()
    endif()
    set(_below "")
    foreach(_part IN LISTS _parts)
        string(REGEX REPLACE "^Bullet" "" _name "${_part}")
        set(_target Bullet::${_name}${_suffix})
        add_library(${_target} UNKNOWN IMPORTED)
        set_target_properties(${_target} PROPERTIES
            IMPORTED_LOCATION "${BulletPrecisions_${_part}_${_precision}_LIBRARY}"
            INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${BulletPrecisions_INCLUDE_DIR}"
            INTERFACE_INCLUDE_DIRECTORIES "${BulletPrecisions_INCLUDE_DIR}"
            INTERFACE_LINK_LIBRARIES "${_below}"
            INTERFACE_BULLET_PRECISION ${_precision}
            COMPATIBLE_INTERFACE_STRING BULLET_PRECISION)
        if(_precision STREQUAL float64)
            set_property(TARGET ${_target} PROPERTY INTERFACE_COMPILE_DEFINITIONS BT_USE_DOUBLE_PRECISION)
        endif()
        set(_below ${_target})
    endforeach()
endforeach()
