#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# compilers.sh [--quick]: the libraries compile without a warning with GCC 11 and 12 and clang 14 to 16, as C++17, 20 and 23,
# Debug and Release, and so does a client without exceptions and run-time types, with warnings that the libraries' own
# sources do not ask for. Prints a table of what was built. With --quick: clang and C++20 once each, Release. Compilers that
# are not there are told and left out.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
compilers=(g++-11 g++-12 clang++-14 clang++-15 clang++-16)
standards=(17 20 23)
build_types=(Release Debug)
quick=0
case ${1-} in
"") ;;
--quick) quick=1 ;;
*) fail "compilers.sh: $1 is not --quick" ;;
esac
install_for_build clang-14

# Indices are int, as in Bullet, and arrays are of the standard library: there a change of sign is no news.
warnings="-Werror -Wpedantic -Wconversion -Wno-sign-conversion"
client_warnings="-Werror -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -fno-exceptions -fno-rtti"
rows=()

# compile <compiler> <standard> <build type>
compile()
{
    local compiler=$1 standard=$2 type=$3 began=$SECONDS
    local build=$root/build/compilers/$compiler-$standard-$type
    if ! command -v "$compiler" >/dev/null; then
        rows+=("$(printf '%-12s C++%s  %-8s not tried: there is no %s' "$compiler" "$standard" "$type" "$compiler")")
        return
    fi
    cmake -S "$root" -B "$build" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_STANDARD="$standard" \
        -DCMAKE_BUILD_TYPE="$type" -DCMAKE_CXX_FLAGS="$warnings" -DBULLETFEM_PRECISIONS=float -DBULLETFEM_UNITY=8 \
        -DBULLETFEM_BUILD_TESTS=OFF -DBULLETFEM_BUILD_DEMOS=OFF -DBULLETFEM_BUILD_TOOLS=OFF \
        -DBULLETFEM_BUILD_BENCHMARKS=OFF -DBULLETFEM_BUILD_PICTURES=OFF >"$build.log" 2>&1 ||
        { cat "$build.log"; fail "$compiler, C++$standard, $type: cannot configure"; }
    cmake --build "$build" --parallel "$(nproc)" >>"$build.log" 2>&1 ||
        { grep -E 'error|Error' -A 6 "$build.log" | head -40; fail "$compiler, C++$standard, $type: see $build.log"; }
    local header
    while IFS= read -r header; do
        echo "#include \"${header#include/}\""
    done < <(cd "$root" && find include -name '*.h' | sort) >"$build/client.cpp"
    # shellcheck disable=SC2086
    "$compiler" -std="c++$(draft_of "$compiler" "$standard")" $client_warnings -Wno-deprecated-declarations -I"$root/include" \
        -isystem /usr/include/bullet -fsyntax-only "$build/client.cpp" || fail "$compiler, C++$standard: a client has warnings"
    rows+=("$(built "$(name_of "$compiler"), $type" "C++$standard" "$(bullet_version /usr/include/bullet)" float \
        "$(system_of_build)" "libraries and a client compile without a warning"), in $((SECONDS - began)) s")
}

# name_of <compiler>: e.g. GCC 12.2.0
name_of()
{
    case $1 in
    clang*) echo "clang $("$1" -dumpversion)" ;;
    *) echo "GCC $("$1" -dumpfullversion)" ;;
    esac
}

# draft_of <compiler> <standard>: its name for it; clang before 17 knows C++23 as 2b.
draft_of()
{
    case $1-$2 in
    clang*-23) echo 2b ;;
    *) echo "$2" ;;
    esac
}

mkdir -p "$root/build/compilers"
if [ $quick = 1 ]; then
    compile clang++-14 17 Release
    compile "${CXX:-g++}" 20 Release
else
    for compiler in "${compilers[@]}"; do
        for standard in "${standards[@]}"; do
            for type in "${build_types[@]}"; do compile "$compiler" "$standard" "$type"; done
        done
    done
fi
printf '%s\n' "${rows[@]}"
