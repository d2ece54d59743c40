#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# wasm.sh <Bullet's source> [<folder>]: builds the browser page of demos/browser as static files in out/browser/ or the
# folder. Installs missing packages (Debian 12, as root or with sudo): emscripten compiles Bullet, BulletFEM::runtime
# (one thread, scalar kernels, single precision) and the scene to WebAssembly; node.js runs the scene. If Chromium and
# python3-websockets are installed they test the page, with pictures in <folder>.pictures.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/tools/ci/stages.sh"
source "$root/cmake/mesh_package.sh"
[ -f "${1-}/src/btBulletDynamicsCommon.h" ] || fail "wasm.sh: '${1-}' is no checkout of Bullet: give its folder"
out=${2:-$root/out/browser}
build=$root/build/wasm
toolchain=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake
mesh_in_archive=data/meshes/elephant.off
tets=2500
young=316228 # [Pa], 10^5.5; this and the following are the initial slider values of the page
poisson=0.4
damping=0.01 # [s]
step=1/60 # [s]
install_for_build emscripten
command -v em++ >/dev/null || fail "wasm.sh: there is no em++: install emscripten"
source "$root/tools/ci/cross.sh"
mkdir -p "$build/scene" "$out"
export NODE_PATH=/usr/share/nodejs # Debian's emscripten needs its acorn, whichever node.js is installed

say "building for this machine what bakes the body, and the same runtime to compare with"
cmake -S "$root" -B "$build/native" -G Ninja -DCMAKE_BUILD_TYPE=Release "${fem_options[@]}" -DBULLETFEM_VECTORS=scalar \
    -DBULLETFEM_BUILD_TOOLS=ON -DBULLETFEM_WITH_ASSIMP=OFF -DBULLETFEM_BUILD_TESTS=OFF >"$build/native.log" 2>&1 ||
    { tail -30 "$build/native.log"; fail "cannot configure, see $build/native.log"; }
cmake --build "$build/native" --parallel "${JOBS:-$(nproc)}" --target bulletfem bulletfem_runtime >>"$build/native.log" 2>&1 ||
    { grep -E 'error|undefined' -A 4 "$build/native.log" | head -40; fail "see $build/native.log"; }
if [ ! -s "$build/$mesh_in_archive" ]; then
    say "extracting $mesh_in_archive from $mesh_package"
    extract_meshes "$build" "$mesh_in_archive" || fail "cannot get $mesh_in_archive from the package $mesh_package"
fi
"$build/native/tools/bulletfem/bulletfem" bake "$build/$mesh_in_archive" -o "$out/elephant.bfem" --tets "$tets" \
    --young "$young" --poisson "$poisson" --stiffness-damping "$damping" --step "$step" >"$build/bake.log"

say "building for WebAssembly"
link_headers
flags=(-fwasm-exceptions -msimd128) # the second one allows vectorization by the compiler
export CFLAGS="${flags[*]}" CXXFLAGS="${flags[*]}"
install_bullet "$1"
cross_install "$root" libraries "${fem_options[@]}" -DBULLETFEM_BULLET="$cross_root" -DBULLETFEM_VECTORS=scalar \
    -DBULLETFEM_BUILD_IO=OFF -DBULLETFEM_BUILD_TESTS=OFF

say "building the scene and the page"
sources=(demos/browser/scene.cpp demos/common/demo_measures.cpp)
common=(-std=c++17 -O3 -DNDEBUG -DBULLETFEM_PRECISION_float "-I$root" "-I$root/include" -isystem "$cross_root/include/eigen3")
bullet=(BulletSoftBody BulletDynamics BulletCollision LinearMath)
(cd "$root" && g++ "${common[@]}" -isystem /usr/include/bullet "${sources[@]}" demos/browser/drag.cpp \
    "$build/native/libbulletfem_runtime.a" "${bullet[@]/#/-l}" -pthread -o "$build/scene/drag")
objects=()
for source in "${sources[@]}" demos/browser/drag.cpp; do
    object=$build/scene/$(basename "$source" .cpp).o
    em++ "${common[@]}" "${flags[@]}" -isystem "$cross_root/include/bullet" -c "$root/$source" -o "$object"
    objects+=("$object")
done
libraries=("-L$cross_root/lib" -lbulletfem_runtime "${bullet[@]/#/-l}" -sALLOW_MEMORY_GROWTH=1)
em++ -O3 "${flags[@]}" "${objects[@]}" "${libraries[@]}" -sNODERAWFS=1 -o "$build/scene/drag.js"
unset 'objects[-1]' # drop drag.cpp from the page
em++ -O3 "${flags[@]}" "${objects[@]}" "${libraries[@]}" --no-entry -sMODULARIZE=1 -sEXPORT_NAME=loadBulletFEM \
    -sENVIRONMENT=web -sFILESYSTEM=0 -sEXPORTED_FUNCTIONS=_malloc,_free -sEXPORTED_RUNTIME_METHODS=UTF8ToString \
    -o "$out/bulletfem.js"
cp "$root/demos/browser/index.html" "$root/demos/browser/page.js" "$out"

say "playing the scene: for this machine, then as WebAssembly in node.js $(node --version)"
"$build/scene/drag" "$out/elephant.bfem"
node --no-experimental-fetch "$build/scene/drag.js" "$out/elephant.bfem" # else Emscripten 3.1.6 reads files by fetch
result="the browser page's scene runs in node.js"
if command -v chromium >/dev/null && /usr/bin/python3 -c 'import websockets' 2>/dev/null; then
    say "playing the page in $(chromium --version 2>/dev/null | cut -d ' ' -f 1-2)"
    /usr/bin/python3 "$root/tests/browser/drag_page.py" "$out" "$out.pictures"
    result="the browser page runs in Chromium and node.js"
else
    say "left out: the page in a browser, for which there must be Debian's chromium and python3-websockets"
fi
for file in bulletfem.wasm bulletfem.js elephant.bfem; do
    say "$file has $(($(stat -c %s "$out/$file") / 1024)) KiB, $(($(gzip -c "$out/$file" | wc -c) / 1024)) compressed"
done
say "the page is in $out; see it with: python3 -m http.server --directory $out"
built "Emscripten $(em++ -dumpversion)" C++17 "$(bullet_version "$1/src")" float WebAssembly "$result"
