#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# Installs missing packages (Debian 12, as root or with sudo), builds and runs all tests except the slow ones, which
# take longer: tests/run.sh -L slow. With arguments it builds all targets and passes them to ctest: tests/run.sh -R
# SurfaceFile
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/cmake/install_packages.sh"
source "$root/cmake/mesh_package.sh"

build=$root/build/release
meshes=data/meshes # path in the package and path expected by the tests

# clang is for the fuzzers of the file readers. Two optional packages with more than a hundred dependencies enable
# further tests: Gmsh (its files) and libvalijson-dev (schema of scenes against the reader).
install_packages "${build_packages[@]}" "${picture_packages[@]}" libgtest-dev libgmock-dev \
    xvfb xauth clang libclang-rt-14-dev "${python_packages[@]}"

if [ ! -d "$build/meshes/$meshes" ]; then
    say "extracting $meshes from $mesh_package"
    extract_meshes "$build/meshes" "$meshes" || say "cannot get them: the test of cages of them will be skipped"
fi

everything=OFF
[ $# -eq 0 ] || everything=ON
say "building in $build"
(cd "$root" && cmake --preset release -DBULLETFEM_UNITY=8 -DBULLETFEM_BUILD_TESTS=ON \
    -DBULLETFEM_BUILD_SLOW_TESTS="$everything" -DBULLETFEM_BUILD_BENCHMARKS="$everything" \
    -DBULLETFEM_PYTHON=ON -DPython_EXECUTABLE=/usr/bin/python3) # Debian's, which has the packages
cmake --build "$build" --parallel "$(nproc)"

# One test uses the Khronos validator from npm; it is skipped with a message if that is unavailable.
if command -v npm >/dev/null && [ ! -d "$build/npm/node_modules/gltf-validator" ]; then
    timeout 120 npm install --silent --no-fund --no-audit --prefix "$build/npm" gltf-validator@2.0.0-dev.3.10 ||
        say "npm could not install gltf-validator: its test will be skipped"
fi

# Each suite is one test unless tests are selected by name, because names may be those of cases.
case " $* " in
*\ -[RE]* | *--tests-regex* | *--exclude-regex*) ;;
*) export BULLETFEM_TEST_SUITES=1 ;;
esac
if [ $# -eq 0 ]; then
    say "running all tests but the slow ones, which tests/run.sh -L slow runs"
    set -- -LE slow
else
    say "running the tests: ctest $*"
fi
ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)" "$@"
