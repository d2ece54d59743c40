# SPDX-License-Identifier: Zlib
# Installs the libraries, the public headers and a package configuration: find_package(BulletFEM) then gives
# BulletFEM::plugin, BulletFEM::plugin-float64 and the others.
include(CMakePackageConfigHelpers)

set(_targets bulletfem_orderings_runtime bulletfem_fem)
foreach(_precision IN LISTS BULLETFEM_PRECISIONS)
    set(_suffix "${BULLETFEM_SUFFIX_${_precision}}")
    list(APPEND _targets bulletfem_bullet_bridge${_suffix} bulletfem_plugin${_suffix})
endforeach()
if(TARGET bulletfem_orderings)
    list(APPEND _targets bulletfem_orderings)
endif()
if(BULLETFEM_BUILD_IO)
    list(APPEND _targets bulletfem_io)
endif()
set(_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/BulletFEM)

install(TARGETS ${_targets} EXPORT BulletFEMTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT BulletFEMTargets NAMESPACE BulletFEM:: DESTINATION ${_config_dir})
install(DIRECTORY include/bullet_fem DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
configure_package_config_file(cmake/BulletFEMConfig.cmake.in "${PROJECT_BINARY_DIR}/BulletFEMConfig.cmake"
    INSTALL_DESTINATION ${_config_dir})
write_basic_package_version_file("${PROJECT_BINARY_DIR}/BulletFEMConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/BulletFEMConfig.cmake" "${PROJECT_BINARY_DIR}/BulletFEMConfigVersion.cmake"
    cmake/FindSuiteSparse.cmake cmake/FindMETIS.cmake cmake/FindBulletPrecisions.cmake DESTINATION ${_config_dir})
install(FILES LICENSE THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
