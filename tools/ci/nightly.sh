#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# nightly.sh [<hours>]: all checks, in about four hours on two cores: those of each commit, all slow tests, all
# compilers, ThreadSanitizer, the Python module under AddressSanitizer, clang-tidy of all sources, shared libraries,
# packages, the minimal runtime, random programs for <hours> in each precision (default 1), and ports to Arm and
# Windows if BULLETFEM_BULLET_SOURCE is Bullet's source tree. A failing stage does not end the run.
#
# The log out/nightly/<date>.tsv has a line per stage: start (UTC), seconds, passed | failed | left out, name.
# <date>/<name>.log has the output of the stage. Exit code 0 if no stage failed.
set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
hours=${1-1}
[[ $hours =~ ^[0-9]+$ ]] || fail "nightly.sh: $hours is no whole number of hours"
date=$(date -u +%Y-%m-%d)
log=$root/out/nightly/$date.tsv
mkdir -p "$root/out/nightly/$date"
printf 'begin\tseconds\tresult\tstage\n' >"$log"
failures=0

# note <start> <seconds> <result> <stage>
note() { printf '%s\t%s\t%s\t%s\n' "$@" | tee -a "$log"; }

# stage <name> <command>...
stage()
{
    local name=$1 begin began=$SECONDS result=passed
    shift
    begin=$(date -u +%H:%M:%S)
    "$@" >"$root/out/nightly/$date/$name.log" 2>&1 </dev/null || result=failed
    [ $result = passed ] || failures=$((failures + 1))
    note "$begin" $((SECONDS - began)) $result "$name"
}

stage commit bash "$root/.ci/run"
stage slow-tests "$root/tests/run.sh" -L slow
stage compilers "$root/tools/ci/compilers.sh"
stage threads "$root/tools/ci/threads.sh"
stage sanitized "$root/tools/ci/sanitize.sh"
stage python-sanitized "$root/tools/ci/sanitize.sh" --python
stage clang-tidy "$root/tools/ci/tidy.sh"
stage runtime "$root/tools/ci/runtime.sh"
stage debian-packages "$root/tools/ci/debs.sh"
if in_git describe --tags --abbrev=0 >/dev/null 2>&1; then
    stage abi "$root/tools/ci/abi.sh"
else
    note - 0 "left out" "abi (there is no tag to compare with)"
fi
for port in arm windows; do
    if [ -d "${BULLETFEM_BULLET_SOURCE-}" ]; then
        stage $port "$root/tools/ci/$port.sh" "$BULLETFEM_BULLET_SOURCE"
    else
        note - 0 "left out" "$port (BULLETFEM_BULLET_SOURCE is no checkout of Bullet)"
    fi
done
for precision in "" -float64; do
    stage "random-programs$precision" "$root/build/release/tests/soak/bulletfem_soak$precision" --seconds $((hours * 3600))
done

say "$failures stages failed: $log"
[ "$failures" -eq 0 ]
