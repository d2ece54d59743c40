#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# runtime.sh: BulletFEM::runtime with minimal dependencies: no oneTBB, AMD, METIS and Assimp, only the headers of
# Highway. Links a tool and a game with it and with Bullet, and runs them. Prints their dependencies, sizes and link
# times.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
build=$root/build/runtime
install_for_build binutils

mkdir -p "$build"
say "building in $build"
cmake -S "$root" -B "$build/libraries" -DCMAKE_BUILD_TYPE=Release -DBULLETFEM_PRECISIONS=float -DBULLETFEM_UNITY=8 \
    -DBULLETFEM_WITH_TBB=OFF -DBULLETFEM_VECTORS=static -DBULLETFEM_WITH_SUITESPARSE=OFF -DBULLETFEM_WITH_METIS=OFF \
    -DBULLETFEM_BUILD_IO=OFF -DBULLETFEM_BUILD_TESTS=OFF -DBULLETFEM_BUILD_TOOLS=OFF -DBULLETFEM_BUILD_DEMOS=OFF \
    -DBULLETFEM_BUILD_BENCHMARKS=OFF -DBULLETFEM_BUILD_PICTURES=OFF >"$build/log" 2>&1 || { cat "$build/log"; fail "cannot configure"; }
cmake --build "$build/libraries" --parallel "${JOBS:-$(nproc)}" >>"$build/log" 2>&1 ||
    { grep -E 'error|undefined' -A 4 "$build/log" | head -40; fail "see $build/log"; }
cmake --install "$build/libraries" --prefix "$build/prefix" >>"$build/log"
# Disabling a package is equivalent to its absence.
missing=()
for package in Eigen3 hwy TBB SuiteSparse METIS assimp tinyxml2 ZLIB; do
    missing+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
done
cmake -S "$root/tests/install" -B "$build/client" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$build/prefix" \
    -DCOMPONENTS=runtime "${missing[@]}" >>"$build/log" 2>&1 || { tail -20 "$build/log"; fail "a client cannot be configured"; }
cmake --build "$build/client" >>"$build/log" 2>&1 || { tail -20 "$build/log"; fail "a client cannot be built"; }
rm "$build/client/player"
began=$(date +%s%N)
cmake --build "$build/client" --target player >>"$build/log"
link_ms=$((($(date +%s%N) - began) / 1000000))
"$build/client/consumer"
"$build/client/baker" "$build/client/body"
"$build/client/player" "$build/client/body"

needed=$(readelf -d "$build/client/player" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | sort | tr '\n' ' ')
say "a game needs $needed"
case $(printf '%s' "$needed" | tr ' ' '\n' | grep -vE '^(lib(Bullet|LinearMath)|libstdc|libm\.|libgcc|libc\.|ld-)' || true) in
"") ;;
*) fail "a game needs more than Bullet and the compiler's libraries" ;;
esac
strip -o "$build/player" "$build/client/player"
say "libbulletfem_runtime.a has $(($(stat -c %s "$build/libraries/libbulletfem_runtime.a") / 1024)) KiB; a game, stripped, \
$(($(stat -c %s "$build/player") / 1024)) KiB; it links in $link_ms ms"
built "GCC $(g++ -dumpfullversion), runtime alone" C++17 "$(bullet_version /usr/include/bullet)" float "$(system_of_build)" \
    "a tool and a game of Bullet and BulletFEM::runtime alone run"
