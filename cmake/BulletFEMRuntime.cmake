# SPDX-License-Identifier: Zlib
# BulletFEM::runtime: one library with all that programs need to simulate baked bodies. It has the plug-in and the
# layers below it, with Eigen's orders instead of AMD and METIS, and without the helpers that read files. It links
# Bullet, and Highway and oneTBB if the project does.
get_property(_floor_objects GLOBAL PROPERTY BULLETFEM_FLOOR_OBJECTS)
foreach(_precision IN LISTS BULLETFEM_PRECISIONS)
    set(_suffix "${BULLETFEM_SUFFIX_${_precision}}")
    set(_objects "$<TARGET_OBJECTS:bulletfem_bullet_bridge${_suffix}>" "$<TARGET_OBJECTS:bulletfem_orderings_runtime>"
        "$<FILTER:$<TARGET_OBJECTS:bulletfem_plugin${_suffix}>,EXCLUDE,btFemFileHelpers|btFemUrdf>")
    list(APPEND _objects ${_floor_objects})
    bulletfem_library(runtime${_suffix} ${_objects})
    set_target_properties(bulletfem_runtime${_suffix} PROPERTIES LINKER_LANGUAGE CXX UNITY_BUILD OFF
        INTERFACE_BULLET_PRECISION ${_precision}
        COMPATIBLE_INTERFACE_STRING "BULLET_PRECISION;BULLETFEM_LIBRARIES" INTERFACE_BULLETFEM_LIBRARIES runtime)
    target_compile_definitions(bulletfem_runtime${_suffix} INTERFACE BULLETFEM_PRECISION_${_precision})
    target_link_libraries(bulletfem_runtime${_suffix} PUBLIC Bullet::SoftBody${_suffix}
        PRIVATE ${BULLETFEM_HWY} ${BULLETFEM_TBB} Threads::Threads)
endforeach()
# Linking both would duplicate all symbols.
set_target_properties(bulletfem_fem PROPERTIES COMPATIBLE_INTERFACE_STRING BULLETFEM_LIBRARIES
    INTERFACE_BULLETFEM_LIBRARIES "plugin, io and fem")
