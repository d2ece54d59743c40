#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# compilers.sh [--quick | --only <compiler> <standard> <build type>]: the libraries compile without warnings with GCC 11
# and 12 and clang 14 to 16, as C++17, 20 and 23, Debug and Release; so does a client without exceptions and RTTI, under
# stricter warnings than those of the libraries' own sources. Prints a table of the builds. --quick: clang and C++20
# once each, Release. --only: e.g. clang++-16 20 Debug. clang++-16:libc++ uses LLVM's standard library (libc++-16-dev,
# which conflicts with other versions). Missing compilers are reported and skipped.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
compilers=(g++-11 g++-12 clang++-14 clang++-15 clang++-16 clang++-16:libc++)
standards=(17 20 23)
build_types=(Release Debug)
chosen=all
case ${1-} in
"") ;;
--quick) chosen=quick ;;
--only)
    [ $# -eq 4 ] || fail "compilers.sh: --only takes a compiler, a standard and a build type"
    chosen=only
    ;;
*) fail "compilers.sh: $1 is neither --quick nor --only" ;;
esac
install_for_build clang-14

# Indices are int, as in Bullet, and index standard containers: conversions of sign are intended.
warnings="-Werror -Wpedantic -Wconversion -Wno-sign-conversion"
client_warnings="-Werror -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -fno-exceptions -fno-rtti"
rows=()

# compile <compiler> <standard> <build type>
compile()
{
    local compiler=${1%:libc++} standard=$2 type=$3 began=$SECONDS library=() name
    local build=$root/build/compilers/$1-$standard-$type
    [ "$compiler" = "$1" ] || library=(-stdlib=libc++)
    if ! is_there "$compiler" "${library[@]}"; then
        rows+=("$(printf '%-12s C++%s  %-8s not tried: it is not there' "$1" "$standard" "$type")")
        return
    fi
    cmake -S "$root" -B "$build" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_STANDARD="$standard" \
        -DCMAKE_BUILD_TYPE="$type" -DCMAKE_CXX_FLAGS="$warnings ${library[*]-}" -DBULLETFEM_PRECISIONS=float -DBULLETFEM_UNITY=8 \
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
    "$compiler" -std="c++$(draft_of "$compiler" "$standard")" "${library[@]}" $client_warnings -Wno-deprecated-declarations -I"$root/include" \
        -isystem /usr/include/bullet -fsyntax-only "$build/client.cpp" || fail "$compiler, C++$standard: a client has warnings"
    name="$(name_of "$compiler"), ${library:+libc++, }$type"
    rows+=("$(built "$name" "C++$standard" "$(bullet_version /usr/include/bullet)" float \
        "$(system_of_build)" "libraries and a client compile without a warning"), in $((SECONDS - began)) s")
}

# is_there <compiler> [-stdlib=<library>]: whether the compiler and its standard library are installed.
is_there()
{
    command -v "$1" >/dev/null && echo '#include <vector>' | "$@" -x c++ -fsyntax-only - 2>/dev/null
}

# name_of <compiler>: e.g. GCC 12.2.0
name_of()
{
    case $1 in
    clang*) echo "clang $("$1" -dumpversion)" ;;
    *) echo "GCC $("$1" -dumpfullversion)" ;;
    esac
}

# draft_of <compiler> <standard>: the compiler's name of the standard; clang before 17 calls C++23 2b.
draft_of()
{
    case $1-$2 in
    clang*-23) echo 2b ;;
    *) echo "$2" ;;
    esac
}

mkdir -p "$root/build/compilers"
case $chosen in
quick)
    compile clang++-14 17 Release
    compile "${CXX:-g++}" 20 Release
    ;;
only) compile "${@:2}" ;;
all)
    for compiler in "${compilers[@]}"; do
        for standard in "${standards[@]}"; do
            for type in "${build_types[@]}"; do compile "$compiler" "$standard" "$type"; done
        done
    done
    ;;
esac
printf '%s\n' "${rows[@]}"
