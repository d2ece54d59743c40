# SPDX-License-Identifier: Zlib
# Debian packages by CPack with BULLETFEM_BUILD_DEBS, which tools/ci/debs.sh sets: shared libraries, development files,
# and the program bulletfem. Package names contain the soname of their library, as usual in Debian.
set(BULLETFEM_MAINTAINER "The BulletFEM authors <bulletfem@example.org>" CACHE STRING "Who answers for Debian packages")
if(NOT BUILD_SHARED_LIBS)
    message(FATAL_ERROR "BULLETFEM_BUILD_DEBS is ON, but BUILD_SHARED_LIBS is not: set both")
endif()
set(_soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(_package_libraries libbulletfem${_soversion})
set(_package_development libbulletfem-dev)
set(_package_tools bulletfem-tools)

find_program(BULLETFEM_GZIP gzip REQUIRED)
mark_as_advanced(BULLETFEM_GZIP)
string(TIMESTAMP _date "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(cmake/debian/changelog.in "${PROJECT_BINARY_DIR}/debian/changelog" @ONLY)
execute_process(COMMAND "${BULLETFEM_GZIP}" -9nf "${PROJECT_BINARY_DIR}/debian/changelog" COMMAND_ERROR_IS_FATAL ANY)
configure_file(cmake/debian/copyright.in "${PROJECT_BINARY_DIR}/debian/copyright" @ONLY)
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/debian/triggers" CONTENT "activate-noawait ldconfig\n")
foreach(_component libraries development tools)
    string(TOUPPER ${_component} _upper)
    set(CPACK_DEBIAN_${_upper}_PACKAGE_NAME ${_package_${_component}})
    set(CPACK_DEBIAN_${_upper}_FILE_NAME DEB-DEFAULT)
    install(FILES "${PROJECT_BINARY_DIR}/debian/changelog.gz" "${PROJECT_BINARY_DIR}/debian/copyright"
        DESTINATION share/doc/${_package_${_component}} COMPONENT ${_component})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL libraries development tools)
if(NOT BULLETFEM_BUILD_TOOLS)
    list(REMOVE_ITEM CPACK_COMPONENTS_ALL tools)
endif()
set(CPACK_PACKAGE_NAME bulletfem)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "${BULLETFEM_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS libraries)
set(CPACK_COMPONENT_TOOLS_DEPENDS libraries)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
get_property(_shared GLOBAL PROPERTY BULLETFEM_SHARED_LIBRARIES)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "")
foreach(_library IN LISTS _shared)
    get_target_property(_folder ${_library} BINARY_DIR)
    list(APPEND CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${_folder}")
endforeach()
list(REMOVE_DUPLICATES CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY >=)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/debian/triggers")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS libbullet-dev)
set(CPACK_COMPONENT_LIBRARIES_DESCRIPTION "Finite-element soft bodies for the Bullet physics engine
 BulletFEM moves tetrahedral soft bodies of Bullet programs by corotational
 finite elements, in SI units. This package has the shared libraries.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Finite-element soft bodies for Bullet, to build programs with
 BulletFEM moves tetrahedral soft bodies of Bullet programs by corotational
 finite elements, in SI units. This package has headers, and what CMake and
 pkg-config need to know.")
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "Makes, simulates and converts finite-element soft bodies
 The program bulletfem makes soft bodies of surfaces, bakes them, runs scenes
 of them with the Bullet physics engine, and writes what moved to files.")
include(CPack)
