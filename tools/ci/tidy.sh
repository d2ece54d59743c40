#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# tidy.sh [--changed]: clang-tidy 14 reports nothing, by the rules of .clang-tidy, in the source files of fem,
# bullet_bridge, plugin and io. --changed: only in files changed since this branch left origin/main, or since the last
# commit but one, and in all files of folders with changed headers. Sources of Highway kernels are read for the
# instruction set of the compiler command, once for each set that Highway compiles.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
changed=0
case ${1-} in
"") ;;
--changed) changed=1 ;;
*) fail "tidy.sh: $1 is not --changed" ;;
esac

is_available clang-tidy-14 clang-tidy-14 || exit 0
install_for_build clang-tidy-14
# Each source file alone and once: no unity build, no precompiled headers, one precision. Nothing is built.
build=$root/build/tidy
(cd "$root" && cmake --preset tidy) >/dev/null || fail "cannot configure build/tidy"
mapfile -t all < <(grep -oP '"file": "\K[^"]+' "$build/compile_commands.json" | sort -u |
    grep -E "^$root/(fem|bullet_bridge|plugin|io)/")
[ ${#all[@]} -gt 0 ] || fail "build/tidy/compile_commands.json has no source files"

# folder_of <header>: folder of its source files.
folder_of()
{
    case $1 in
    include/bullet_fem/fem/*/*) dirname "${1#include/bullet_fem/}" ;;
    include/bullet_fem/io/*) echo io ;;
    include/bullet_fem/*) echo plugin ;;
    *) dirname "$1" ;;
    esac
}

# changed_sources <commit>: the changed files of `all`, one per line; paths relative to the root.
changed_sources()
{
    local path
    changed_files "$1" | while IFS= read -r path; do
        case $path in
        .clang-tidy) printf '%s\n' "${all[@]}" ;;
        *.cpp) printf '%s\n' "${all[@]}" | grep -Fx "$root/$path" ;;
        *.h) printf '%s\n' "${all[@]}" | grep -E "^$root/$(folder_of "$path")/" ;;
        esac
    done | sort -u
}

files=("${all[@]}")
if [ "$changed" -eq 1 ]; then
    base=$(base_commit)
    if [ -z "$base" ]; then
        say "there is no commit to compare with: all files"
    else
        mapfile -t files < <(changed_sources "$base" || true)
        say "${#files[@]} of ${#all[@]} source files are touched since $(in_git rev-parse --short "$base")"
    fi
fi
[ ${#files[@]} -gt 0 ] || exit 0

# Suppresses messages on options that only GCC has. Shows headers by their paths in the source tree.
printf '%s\0' "${files[@]}" |
    xargs -0 -P "$(nproc)" -n 1 clang-tidy-14 -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option \
        --extra-arg=-Wno-ignored-optimization-argument 2> >(grep -vE '^[0-9]+ warnings? (generated|treated)' >&2) |
    sed -E "s#$build/rooms/[^/]+/##; s#$root/##" ||
    fail "clang-tidy finds the above (rules: .clang-tidy)"
say "${#files[@]} source files: nothing found"
