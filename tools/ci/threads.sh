#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# threads.sh: runs tests of threads and a minute of random programs under ThreadSanitizer.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
build=$root/build/threads # separate from other scripts' build folders, because options differ
programs=(fem_threads actuation elasticity threads policy accurate_bending breaking cloth regions skin torsional_friction)
programs=("${programs[@]/#/bulletfem_}")
programs=("${programs[@]/%/_test}")
# Allocations are not counted: here each run of tasks creates its threads (fem/common/threads.cpp).
filter='*hread*:*Shared*:*BatchMemory*:*Concurrent*:*FactorJobs*:*BackgroundRefactoring*-*llocat*'

install_for_build "${test_packages[@]}"

# Threading does not depend on the kernels' instruction set, and each further set would take as long again.
(cd "$root" && cmake --preset tsan -B "$build" -DBULLETFEM_UNITY=8 -DBULLETFEM_PRECISIONS=float -DBULLETFEM_VECTORS=static \
    -DBULLETFEM_BUILD_PICTURES=OFF "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O2 -g1 -DNDEBUG")
cmake --build "$build" --parallel "$(nproc)" --target "${programs[@]}" bulletfem_soak
export TSAN_OPTIONS=halt_on_error=1
for program in "${programs[@]}"; do
    say "$program"
    found=$(find "$build/tests" -name "$program" -type f)
    "$found" --gtest_filter="$filter" --gtest_list_tests | grep '^  ' >/dev/null ||
        fail "$program: none of its tests has to do with threads"
    (cd "$(dirname "$found")" && "$found" --gtest_filter="$filter" --gtest_brief=1) ||
        fail "$program: a race or a failure stands above"
done
say "random programs"
"$build/tests/soak/bulletfem_soak" --seconds 60 || fail "the commands that repeat it stand above; they tell the race in $build"
