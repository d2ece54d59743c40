#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# arm.sh <Bullet's source>: builds the libraries for 64-bit Arm by Debian's cross compiler, with their own build of
# Bullet. Under QEMU with NEON it runs an installed client and the tests of kernels, factor and steps. Single precision,
# without oneTBB, AMD and METIS. FILTER in the environment selects other tests of fem.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
build=$root/build/arm
toolchain=$root/cmake/aarch64-linux-gnu.cmake
[ -f "${1-}/src/btBulletDynamicsCommon.h" ] || fail "arm.sh: '${1-}' is no checkout of Bullet: give its folder"
install_for_build g++-aarch64-linux-gnu qemu-user googletest
source "$root/tools/ci/cross.sh"
mkdir -p "$build"
link_headers
install_googletest
install_bullet "$1"
options=("${fem_options[@]}" -DBULLETFEM_BULLET="$cross_root" -DBULLETFEM_BUILD_IO=OFF)
qemu=(qemu-aarch64 -L /usr/aarch64-linux-gnu)

say "building the libraries"
cross_install "$root" libraries "${options[@]}" -DBULLETFEM_BUILD_TESTS=OFF
cross "$root/tests/install" client
say "a client under QEMU"
"${qemu[@]}" "$build/client/consumer"
"${qemu[@]}" "$build/client/baker" "$build/client/body"
"${qemu[@]}" "$build/client/player" "$build/client/body"
version=$(qemu-aarch64 --version | sed -n 's/.*version \([0-9.]*\).*/\1/p')
row=("GCC $(aarch64-linux-gnu-g++ -dumpfullversion)" C++17 "$(bullet_version "$1/src")" float "Debian 12, AArch64")
built "${row[@]}" "libraries and a client run under QEMU $version"
say "tests of fem under QEMU"
cross "$root" tests -t bulletfem_fem_test -t bulletfem_fem_threads_test "${options[@]}" -DBULLETFEM_BUILD_TESTS=ON
filter=${FILTER:-'*Element*:*Kernel*:*Packed*:*NumericFactor*:*LaneGradients*:WorkingSet*:*Step*:*Batch*:*BodyModel*'}
for program in fem fem_threads; do
    "${qemu[@]}" "$build/tests/tests/fem/bulletfem_${program}_test" --gtest_brief=1 --gtest_filter="$filter"
done
built "${row[@]}" "libraries, a client and tests of kernels, factor and steps run under QEMU $version"
