# SPDX-License-Identifier: Zlib
# Finds the single-precision Bullet of the system as imported targets, which CMake's own FindBullet does not make.
#   Bullet::SoftBody, Bullet::Dynamics, Bullet::Collision, Bullet::LinearMath
find_path(BulletFloat_INCLUDE_DIR NAMES btBulletDynamicsCommon.h PATH_SUFFIXES bullet)
set(_vars BulletFloat_INCLUDE_DIR)
foreach(_part SoftBody Dynamics Collision)
    find_library(BulletFloat_${_part}_LIBRARY NAMES Bullet${_part})
    list(APPEND _vars BulletFloat_${_part}_LIBRARY)
endforeach()
find_library(BulletFloat_LinearMath_LIBRARY NAMES LinearMath)
list(APPEND _vars BulletFloat_LinearMath_LIBRARY)
mark_as_advanced(${_vars})

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BulletFloat REQUIRED_VARS ${_vars}
    REASON_FAILURE_MESSAGE "install libbullet-dev")

if(BulletFloat_FOUND AND NOT TARGET Bullet::SoftBody)
    foreach(_part LinearMath Collision Dynamics SoftBody)
        add_library(Bullet::${_part} UNKNOWN IMPORTED)
        set_target_properties(Bullet::${_part} PROPERTIES
            IMPORTED_LOCATION "${BulletFloat_${_part}_LIBRARY}"
            INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${BulletFloat_INCLUDE_DIR}"
            INTERFACE_INCLUDE_DIRECTORIES "${BulletFloat_INCLUDE_DIR}")
    endforeach()
    set_property(TARGET Bullet::Collision PROPERTY INTERFACE_LINK_LIBRARIES Bullet::LinearMath)
    set_property(TARGET Bullet::Dynamics PROPERTY INTERFACE_LINK_LIBRARIES Bullet::Collision)
    set_property(TARGET Bullet::SoftBody PROPERTY INTERFACE_LINK_LIBRARIES Bullet::Dynamics)
endif()
