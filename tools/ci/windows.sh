#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# windows.sh <Bullet's source> [<tinyxml2's source>]: builds the libraries for Windows by MinGW-w64 with POSIX threads
# and their own build of Bullet, and runs the tests of fem and an installed client under Wine; without Wine they are
# only compiled. io is built if tinyxml2's source is given; Assimp is left out. Single precision, without oneTBB, AMD
# and METIS. First, clang parses all sources with Microsoft's extensions and late template parsing.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
build=$root/build/windows
toolchain=$root/cmake/x86_64-w64-mingw32.cmake
[ -f "${1-}/src/btBulletDynamicsCommon.h" ] || fail "windows.sh: '${1-}' is no checkout of Bullet: give its folder"
[ -z "${2-}" ] || [ -f "$2/tinyxml2.cpp" ] || fail "windows.sh: '$2' has no tinyxml2.cpp: give tinyxml2's folder, or nothing"
install_for_build g++-mingw-w64-x86-64-posix libz-mingw-w64-dev googletest clang-14
source "$root/tools/ci/cross.sh"
mkdir -p "$build"

say "clang reads the sources as Microsoft's compiler would"
count=0
while IFS= read -r path; do
    clang++-14 -std=c++17 -fsyntax-only -fms-extensions -fdelayed-template-parsing -Wno-everything \
        -DHWY_COMPILE_ONLY_SCALAR -DBULLETFEM_PRECISION_float -I"$root" -I"$root/include" -isystem "$1/src" \
        -isystem /usr/include/eigen3 "$root/$path" || fail "$path: clang with -fms-extensions refuses it"
    count=$((count + 1))
done < <(cd "$root" && find fem bullet_bridge plugin io -name '*.cpp' | sort)
say "$count sources"

link_headers
install_bullet "$1"
io=OFF
if [ -n "${2-}" ]; then
    io=ON
    mkdir -p "$build/tinyxml2-source"
    cp "$2/tinyxml2.cpp" "$2/tinyxml2.h" "$build/tinyxml2-source"
    cat >"$build/tinyxml2-source/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(tinyxml2 CXX)
add_library(tinyxml2 STATIC tinyxml2.cpp)
target_include_directories(tinyxml2 PUBLIC $<INSTALL_INTERFACE:include>)
install(TARGETS tinyxml2 EXPORT tinyxml2)
install(FILES tinyxml2.h TYPE INCLUDE)
install(EXPORT tinyxml2 NAMESPACE tinyxml2:: FILE tinyxml2Config.cmake DESTINATION lib/cmake/tinyxml2)
CMAKE
    cross_install "$build/tinyxml2-source" tinyxml2
    ln -sfn /usr/x86_64-w64-mingw32/include/zlib.h "$cross_root/include/zlib.h"
    ln -sfn /usr/x86_64-w64-mingw32/include/zconf.h "$cross_root/include/zconf.h"
    ln -sfn /usr/x86_64-w64-mingw32/lib/libz.a "$cross_root/lib/libz.a"
fi
wine=$(command -v wine64 || command -v wine || true)
tests=OFF
if [ -n "$wine" ]; then
    tests=ON
    export WINEPREFIX=$build/wine WINEDEBUG=-all
    install_googletest
fi

# 64-bit Windows does not align 32-byte vectors on the stack [GCC 54412]: SSE4 at most.
vectors="-msse4.2 -maes -mpclmul"
options=("${fem_options[@]}" -DBULLETFEM_BULLET="$cross_root" -DBULLETFEM_BUILD_IO="$io" -DBULLETFEM_WITH_ASSIMP=OFF
    -DCMAKE_CXX_FLAGS="$vectors")
say "building the libraries"
cross_install "$root" libraries "${options[@]}" -DBULLETFEM_BUILD_TESTS=OFF
cross "$root/tests/install" client
row=("MinGW-w64 GCC $(x86_64-w64-mingw32-g++-posix -dumpversion)" C++17 "$(bullet_version "$1/src")" float "Windows, x86-64")
result="libraries and a client compiled, not run: there is no Wine"
if [ $tests = ON ]; then
    say "a client under Wine"
    "$wine" "$build/client/consumer.exe"
    "$wine" "$build/client/baker.exe" "$build/client/body"
    "$wine" "$build/client/player.exe" "$build/client/body"
    built "${row[@]}" "libraries and a client run under $("$wine" --version)"
    say "the tests of fem under Wine"
    cross "$root" tests -t bulletfem_fem_test -t bulletfem_fem_threads_test "${options[@]}" -DBULLETFEM_BUILD_TESTS=ON
    for program in fem fem_threads; do
        "$wine" "$build/tests/tests/fem/bulletfem_${program}_test.exe" --gtest_brief=1
    done
    result="libraries, a client and tests of fem run under $("$wine" --version)"
fi
built "${row[@]}" "$result"
