#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# slow.sh: runs slow tests of files changed since this branch left origin/main, or since the last commit but one, in
# single precision; at most two programs, those of the first matching rows below. tests/run.sh -L slow runs all.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
build=$root/build/release # shared with tests/run.sh

# Programs and the files that they cover; each takes one to four minutes.
covers=(
    "bulletfem_contact_slow_test ^(fem/contact|bullet_bridge/(contact|geometry|rigid)|include/bullet_fem/fem/contact)/"
    "bulletfem_motion_slow_test ^(fem/(body|batch|solve|step)|include/bullet_fem/fem/(body|batch|step))/"
    "bulletfem_snapshot_test snapshot"
    "bulletfem_stack_test ^(plugin/(stages|coupling|world)|bullet_bridge/joints)"
    "bulletfem_examples_test ^(fem/(elements|factor|mesh|common)|bullet_bridge/body|include/bullet_fem/btFem)"
    "bulletfem_demo_scenes_test ^(demos|tools/scene)/"
    "bulletfem_random_program_test ^(plugin|bullet_bridge|include)/"
)

base=$(base_commit)
if [ -z "$base" ]; then
    say "there is no commit to compare with: no slow tests"
    exit 0
fi
chosen=()
for row in "${covers[@]}"; do
    [ ${#chosen[@]} -lt 2 ] || break
    ! changed_files "$base" | grep -qE "${row#* }" || chosen+=("${row%% *}")
done
if [ ${#chosen[@]} -eq 0 ]; then
    say "no slow test covers what has changed since $(in_git rev-parse --short "$base")"
    exit 0
fi

(cd "$root" && cmake --preset release -DBULLETFEM_UNITY=8 -DBULLETFEM_BUILD_TESTS=ON -DBULLETFEM_BUILD_SLOW_TESTS=ON) >/dev/null
cmake --build "$build" --parallel "$(nproc)" --target "${chosen[@]}"
for program in "${chosen[@]}"; do
    found=$(find "$build/tests" -name "$program" -type f)
    say "$program"
    (cd "$(dirname "$found")" && "./$program" --gtest_brief=1) || fail "$program: run $found again"
done
