#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# run_fuzzer.sh <build folder of the fuzzers> <reader>: executes the fuzzer from its seeds, reproducibly.
# BULLETFEM_FUZZ_RUNS is the number of executions; BULLETFEM_FUZZ_SECONDS, if set, the time in its place, with another
# random seed each time and a corpus that is kept for the next. Failing inputs are left in <build folder>/failed.
set -euo pipefail
build=$1 reader=$2

if [ -n "${BULLETFEM_FUZZ_SECONDS:-}" ]; then
    corpus=$build/kept/$reader
    length=(-max_total_time="$BULLETFEM_FUZZ_SECONDS")
else
    corpus=$build/corpus/$reader
    length=(-runs="${BULLETFEM_FUZZ_RUNS:-100000}" -seed=1)
    rm -rf "$corpus"
fi
mkdir -p "$corpus" "$build/failed"
exec "$build/fuzz_$reader" "${length[@]}" -max_len=4096 -timeout=10 -rss_limit_mb=1024 -detect_leaks=0 \
    -print_final_stats=1 -artifact_prefix="$build/failed/$reader-" "$corpus" "$build/seeds/$reader"
