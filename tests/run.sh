#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# Installs what is missing (Debian 12, as root or with sudo), builds everything and runs all tests.
# Further arguments go to ctest: tests/run.sh -R SurfaceFile
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/cmake/install_packages.sh"

build=$root/build/release

# clang is for the fuzzers of the file readers. Gmsh, if it is installed, adds tests of the files that it writes.
install_packages "${build_packages[@]}" "${picture_packages[@]}" libgtest-dev libgmock-dev nlohmann-json3-dev \
    xvfb xauth clang libclang-rt-14-dev

say "building in $build"
(cd "$root" && cmake --preset release)
cmake --build "$build" --parallel "$(nproc)"

say "running the tests"
ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)" "$@"
