#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# threads.sh: the tests of threads under ThreadSanitizer, of fem, the bridge and worlds.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
build=$root/build/threads # of its own, so that no script changes the options of another's
programs=(bulletfem_fem_test bulletfem_elasticity_test bulletfem_plugin_test bulletfem_contact_test)
filter='*Thread*:*SharedBody*:*Batch*:*Repeatable*'

install_for_build "${test_packages[@]}"

(cd "$root" && cmake --preset tsan -B "$build" -DBULLETFEM_UNITY=8 -DBULLETFEM_PRECISIONS=float \
    "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O2 -g1 -DNDEBUG")
cmake --build "$build" --parallel "$(nproc)" --target "${programs[@]}"
export TSAN_OPTIONS=halt_on_error=1
for program in "${programs[@]}"; do
    say "$program"
    found=$(find "$build/tests" -name "$program" -type f)
    (cd "$(dirname "$found")" && "$found" --gtest_filter="$filter-*llocat*" --gtest_brief=1) ||
        fail "$program: a race or a failure stands above"
done
