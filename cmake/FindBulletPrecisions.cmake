# SPDX-License-Identifier: Zlib
# Finds Bullet and creates imported targets that CMake's own FindBullet lacks. Both precisions share Bullet's headers;
# BT_USE_DOUBLE_PRECISION selects the layout.
#   component float    Bullet::SoftBody, Bullet::Dynamics, Bullet::Collision, Bullet::LinearMath
#   component float64  Bullet::SoftBody-float64 and so on, with BT_USE_DOUBLE_PRECISION in their interface
# Each target has its precision in the property BULLET_PRECISION; CMake stops with an error if a target would get both.
# BulletPrecisions_VERSION is the version of the headers, e.g. 3.24; find_package(BulletPrecisions 3.23) requires one.
#
# BULLETFEM_BULLET selects the Bullet to use:
#   targets    that of this build: targets BulletSoftBody and so on of Bullet's own CMakeLists.txt, created before
#   system     both precisions in one installation, as Debian ships them, in CMake's search path for libraries
#   a folder   an installation by Bullet's own CMakeLists.txt, or Debian's layout below that folder; or a source tree, of
#              which targets have the headers alone: enough for static libraries
# Empty: targets if they exist, else system.
set(_parts LinearMath BulletCollision BulletDynamics BulletSoftBody)
set(_suffix_float "")
set(_suffix_float64 "-float64")

set(_bullet "${BULLETFEM_BULLET}")
if(NOT _bullet AND TARGET BulletSoftBody)
    set(_bullet targets)
elseif(NOT _bullet)
    set(_bullet system)
endif()
if(NOT _bullet MATCHES "^(targets|system)$" AND NOT IS_DIRECTORY "${_bullet}")
    message(FATAL_ERROR "BULLETFEM_BULLET is ${_bullet}: it must be targets, system or a folder that Bullet is installed in, or its source")
endif()

# Results of another choice are discarded.
if(NOT "${BulletPrecisions_CHOICE}" STREQUAL "${_bullet}")
    unset(BulletPrecisions_INCLUDE_DIR CACHE)
    foreach(_part IN LISTS _parts)
        unset(BulletPrecisions_${_part}_float_LIBRARY CACHE)
        unset(BulletPrecisions_${_part}_float64_LIBRARY CACHE)
    endforeach()
endif()
set(BulletPrecisions_CHOICE "${_bullet}" CACHE INTERNAL "The Bullet that was found")

set(BulletPrecisions_float_FOUND FALSE)
set(BulletPrecisions_float64_FOUND FALSE)
set(BulletPrecisions_HEADERS_ALONE FALSE)
if(_bullet STREQUAL "targets")
    foreach(_part IN LISTS _parts)
        if(NOT TARGET ${_part})
            message(FATAL_ERROR "BULLETFEM_BULLET is targets, but there is no target ${_part}: add Bullet's folder before "
                "BulletFEM's, or set BULLETFEM_BULLET to system or to a folder")
        endif()
    endforeach()
    get_target_property(_source BulletSoftBody SOURCE_DIR)
    get_filename_component(BulletPrecisions_INCLUDE_DIR "${_source}" DIRECTORY)
    get_directory_property(_definitions DIRECTORY "${_source}" COMPILE_DEFINITIONS)
    get_target_property(_of_target BulletSoftBody COMPILE_DEFINITIONS)
    if("BT_USE_DOUBLE_PRECISION" IN_LIST _definitions OR "BT_USE_DOUBLE_PRECISION" IN_LIST _of_target)
        set(BulletPrecisions_float64_FOUND TRUE)
    else()
        set(BulletPrecisions_float_FOUND TRUE)
    endif()
elseif(EXISTS "${_bullet}/src/btBulletDynamicsCommon.h")
    set(BulletPrecisions_INCLUDE_DIR "${_bullet}/src")
    set(BulletPrecisions_HEADERS_ALONE TRUE)
    set(BulletPrecisions_float_FOUND TRUE)
    set(BulletPrecisions_float64_FOUND TRUE)
else()
    set(_where "")
    if(NOT _bullet STREQUAL "system")
        set(_where PATHS "${_bullet}" NO_DEFAULT_PATH)
        # Bullet's own installation has a single precision and no suffix.
        file(GLOB _own "${_bullet}/lib*/cmake/*/BulletConfig.cmake")
        if(_own)
            list(GET _own 0 _own)
            file(STRINGS "${_own}" _double REGEX "BT_USE_DOUBLE_PRECISION")
            set(_suffix_float64 "")
        endif()
    endif()
    find_path(BulletPrecisions_INCLUDE_DIR NAMES btBulletDynamicsCommon.h PATH_SUFFIXES bullet include/bullet ${_where})
    mark_as_advanced(BulletPrecisions_INCLUDE_DIR)
    foreach(_precision float float64)
        set(BulletPrecisions_${_precision}_FOUND TRUE)
        foreach(_part IN LISTS _parts)
            find_library(BulletPrecisions_${_part}_${_precision}_LIBRARY NAMES ${_part}${_suffix_${_precision}}
                PATH_SUFFIXES lib lib64 ${_where})
            mark_as_advanced(BulletPrecisions_${_part}_${_precision}_LIBRARY)
            if(NOT BulletPrecisions_${_part}_${_precision}_LIBRARY)
                set(BulletPrecisions_${_precision}_FOUND FALSE)
            endif()
        endforeach()
    endforeach()
    if(_suffix_float64 STREQUAL "" AND _double)
        set(BulletPrecisions_float_FOUND FALSE)
    elseif(_suffix_float64 STREQUAL "")
        set(BulletPrecisions_float64_FOUND FALSE)
    endif()
endif()
if(BulletPrecisions_INCLUDE_DIR)
    file(STRINGS "${BulletPrecisions_INCLUDE_DIR}/LinearMath/btScalar.h" BulletPrecisions_VERSION
        REGEX "^#define BT_BULLET_VERSION [0-9]+")
    # 324 means 3.24.
    string(REGEX REPLACE "^.* ([0-9])([0-9]+)$" "\\1.\\2" BulletPrecisions_VERSION "${BulletPrecisions_VERSION}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BulletPrecisions REQUIRED_VARS BulletPrecisions_INCLUDE_DIR HANDLE_COMPONENTS
    VERSION_VAR BulletPrecisions_VERSION
    REASON_FAILURE_MESSAGE "install libbullet-dev, or set BULLETFEM_BULLET to the folder of your own Bullet")

foreach(_precision float float64)
    set(_suffix "")
    if(_precision STREQUAL float64)
        set(_suffix "-float64")
    endif()
    if(NOT BulletPrecisions_FOUND OR NOT BulletPrecisions_${_precision}_FOUND OR TARGET Bullet::SoftBody${_suffix})
        continue()
    endif()
    set(_below "")
    foreach(_part IN LISTS _parts)
        string(REGEX REPLACE "^Bullet" "" _name "${_part}")
        set(_target Bullet::${_name}${_suffix})
        if(_bullet STREQUAL "targets")
            add_library(${_target} INTERFACE IMPORTED GLOBAL)
            list(PREPEND _below ${_part})
        elseif(BulletPrecisions_HEADERS_ALONE)
            add_library(${_target} INTERFACE IMPORTED GLOBAL)
        else()
            add_library(${_target} UNKNOWN IMPORTED)
            set_target_properties(${_target} PROPERTIES
                IMPORTED_LOCATION "${BulletPrecisions_${_part}_${_precision}_LIBRARY}")
        endif()
        set_target_properties(${_target} PROPERTIES
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
