#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# fuzz.sh [seconds a reader, 600 unless given] [reader...]: fuzzes the file readers for longer than the tests do.
# The corpus is kept, so that the next run continues from it. Needs clang++ with libFuzzer; run tests/run.sh before.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build/release
seconds=${1:-600}
readers=("${@:2}")
[ ${#readers[@]} -gt 0 ] || readers=(gmsh tetgen vtk vtu medit off ply)

cmake --build "$build" --target bulletfem_fuzzers
for reader in "${readers[@]}"; do
    printf '== %s for %s s\n' "$reader" "$seconds"
    BULLETFEM_FUZZ_SECONDS=$seconds "$root/tests/fuzz/run_fuzzer.sh" "$build/tests/fuzz/readers" "$reader" 2>&1 |
        grep -vE '^#[0-9]+\s+(NEW|REDUCE|RELOAD)'
done
