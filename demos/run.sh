#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# Installs missing packages (Debian 12, as root or with sudo), builds README's first program and the drop demo, runs
# them, the latter with a scanned elephant, and draws pictures.
# Further arguments are passed to the demo: demos/run.sh --young 2e5 --seconds 2
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/cmake/install_packages.sh"
source "$root/cmake/mesh_package.sh"

mesh_in_archive=data/meshes/elephant.off
build=$root/build/release # shared with tests/run.sh, which builds the other targets
mesh=$build/$mesh_in_archive

install_packages "${build_packages[@]}" "${picture_packages[@]}"

if [ ! -s "$mesh" ]; then
    say "extracting $mesh_in_archive from $mesh_package"
    extract_meshes "$build" "$mesh_in_archive" || fail "cannot get $mesh_in_archive from the package $mesh_package"
fi

say "building in $build"
if [ ! -f "$build/build.ninja" ]; then # otherwise keep the present options
    (cd "$root" && cmake --preset release -DBULLETFEM_UNITY=8 -DBULLETFEM_BUILD_TESTS=OFF -DBULLETFEM_BUILD_BENCHMARKS=OFF)
fi
cmake --build "$build" --target bulletfem_hello bulletfem_drop bulletfem --parallel "$(nproc)"

say "running README's first program, demos/hello/hello.cpp"
"$build/demos/bulletfem_hello"

say "running the demo; its frames go to $root/out/drop unless --out says otherwise"
"$build/demos/bulletfem_drop" --mesh "$mesh" --out "$root/out/drop" "$@"

say "drawing it, as the scene demos/scenes/drop.json"
"$build/tools/bulletfem/bulletfem" simulate "$root/demos/scenes/drop.json" --png --out "$root/out/drop" ||
    say "no pictures: see above; everything else is in $root/out/drop"
