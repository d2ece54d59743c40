# SPDX-License-Identifier: Zlib
# An overlay port: vcpkg install bulletfem --overlay-ports=tools/ports/vcpkg. It builds the source tree that contains
# it. vcpkg's own Bullet has single precision only.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../.." ABSOLUTE)
vcpkg_check_linkage(ONLY_STATIC_LIBRARY)
vcpkg_check_features(OUT_FEATURE_OPTIONS FEATURE_OPTIONS FEATURES
    io BULLETFEM_BUILD_IO
    metis BULLETFEM_WITH_METIS
    threads BULLETFEM_WITH_TBB)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS ${FEATURE_OPTIONS}
    "-DBULLETFEM_BULLET=${CURRENT_INSTALLED_DIR}" -DBULLETFEM_PRECISIONS=float -DBULLETFEM_WITH_SUITESPARSE=OFF
    -DBULLETFEM_BUILD_TESTS=OFF -DBULLETFEM_BUILD_DEMOS=OFF -DBULLETFEM_BUILD_TOOLS=OFF -DBULLETFEM_BUILD_BENCHMARKS=OFF
    -DBULLETFEM_BUILD_PICTURES=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME BulletFEM CONFIG_PATH lib/cmake/BulletFEM)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
