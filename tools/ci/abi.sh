#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# abi.sh [<commit>]: checks binary compatibility of the shared libraries. Builds them, tests their exports and a client
# linked with them; then builds those of the commit (default: the last tag) and compares both by abidiff. Fails if
# public names were removed or changed under an unchanged soname. Single precision.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
build=$root/build/abi
install_for_build abigail-tools
command -v abidiff >/dev/null || fail "there is no abidiff: install abigail-tools"

# shared_libraries <source> <folder> <option>...: builds them in the folder, with debug information for abidiff.
shared_libraries()
{
    local source=$1 folder=$2
    shift 2
    mkdir -p "$folder"
    cmake -S "$source" -B "$folder" -DBUILD_SHARED_LIBS=ON -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=-g \
        -DBULLETFEM_PRECISIONS=float -DBULLETFEM_UNITY=8 -DBULLETFEM_BUILD_TOOLS=OFF -DBULLETFEM_BUILD_DEMOS=OFF \
        -DBULLETFEM_BUILD_BENCHMARKS=OFF -DBULLETFEM_BUILD_PICTURES=OFF "$@" >"$folder.log" 2>&1 ||
        { cat "$folder.log"; fail "$source: cannot configure"; }
    cmake --build "$folder" --parallel "${JOBS:-$(nproc)}" >>"$folder.log" 2>&1 || { tail -40 "$folder.log"; fail "see $folder.log"; }
}

soname_of() { readelf -d "$1" | sed -n 's/.*soname: \[\(.*\)\].*/\1/p'; }

shared_libraries "$root" "$build/new"
ctest --test-dir "$build/new" --output-on-failure -R '^(install|runtime)\.'

before=${1:-$(in_git describe --tags --abbrev=0 2>/dev/null || true)}
if [ -z "$before" ]; then
    say "there is no tag and no commit is given: nothing to compare with"
    exit 0
fi
rm -rf "$build/source"
mkdir -p "$build/source"
in_git archive "$before" | tar -x -C "$build/source"
shared_libraries "$build/source" "$build/old" -DBULLETFEM_BUILD_TESTS=OFF

for library in "$build"/new/*/libbulletfem_*.so; do
    part=${library#"$build/new/"}
    if [ ! -e "$build/old/$part" ]; then
        say "$part: new"
        continue
    fi
    if [ "$(soname_of "$library")" != "$(soname_of "$build/old/$part")" ]; then
        say "$part: $(soname_of "$library") has taken the place of $(soname_of "$build/old/$part")"
        continue
    fi
    # New names are compatible. Bits 4 and 8 of the status: names were removed, or names or their types have changed.
    status=0
    abidiff --no-default-suppression --no-added-syms --headers-dir1 "$build/source/include" --headers-dir2 "$root/include" \
        "$build/old/$part" "$library" || status=$?
    [ $((status & 3)) -eq 0 ] || fail "$part: abidiff could not compare"
    [ $((status & 12)) -eq 0 ] || fail "$part: not what $before promised, and it has the same soname: raise the version"
    say "$part: keeps what $before promised"
done
