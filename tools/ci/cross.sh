# SPDX-License-Identifier: Zlib
# shellcheck shell=bash disable=SC2154,SC2034
# Sourced by windows.sh and arm.sh, which set root, build (a folder), toolchain and load stages.sh: dependencies of both
# cross builds, in $build/root. The instruction set is fixed at compile time, so that Highway needs no library.
cross_root=$build/root

# link_headers: links header-only libraries into a folder apart from this machine's other headers.
link_headers()
{
    mkdir -p "$cross_root/include" "$cross_root/lib/cmake/nlohmann_json"
    local header
    for header in eigen3 hwy xxhash.h tiny_gltf.h nlohmann; do
        ln -sfn "/usr/include/$header" "$cross_root/include/$header"
    done
    cat >"$cross_root/lib/cmake/nlohmann_json/nlohmann_jsonConfig.cmake" <<CMAKE
if(NOT TARGET nlohmann_json::nlohmann_json)
    add_library(nlohmann_json::nlohmann_json INTERFACE IMPORTED)
    set_target_properties(nlohmann_json::nlohmann_json PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "$cross_root/include")
endif()
CMAKE
}

# cross <source> <name> [-t <target>]... [<option>...]: configures in $build/<name>, and builds the targets or
# everything.
cross()
{
    local source=$1 folder=$build/$2 targets=()
    shift 2
    while [ "${1-}" = -t ]; do
        targets+=(--target "$2")
        shift 2
    done
    cmake -S "$source" -B "$folder" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$toolchain" -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_FIND_ROOT_PATH="$cross_root" -DCMAKE_PREFIX_PATH="$cross_root" -DEigen3_DIR=/usr/share/eigen3/cmake \
        -DCMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache || true)" -DCMAKE_INSTALL_PREFIX="$cross_root" "$@" \
        >"$folder.log" 2>&1 || { tail -30 "$folder.log"; fail "$source: cannot configure, see $folder.log"; }
    cmake --build "$folder" --parallel "${JOBS:-$(nproc)}" "${targets[@]}" >>"$folder.log" 2>&1 ||
        { grep -E 'error|undefined' -A 4 "$folder.log" | head -40; fail "$source: see $folder.log"; }
}

# cross_install <source> <name> [<option>...]: as cross, then installs in $cross_root.
cross_install()
{
    cross "$@"
    cmake --install "$build/$2" >>"$build/$2.log" 2>&1 || fail "$1: cannot install, see $build/$2.log"
}

# install_bullet <its source>: single precision, libraries only.
install_bullet()
{
    local off=() option
    for option in BUILD_CPU_DEMOS BUILD_BULLET2_DEMOS BUILD_OPENGL3_DEMOS BUILD_UNIT_TESTS BUILD_EXTRAS BUILD_BULLET3; do
        off+=("-D$option=OFF")
    done
    cross_install "$1" bullet "${off[@]}" -DINSTALL_LIBS=ON -DUSE_DOUBLE_PRECISION=OFF -DCMAKE_CXX_FLAGS=-w
}

install_googletest() { cross_install /usr/src/googletest googletest; }

# Options of BulletFEM in each cross build.
fem_options=(-DBULLETFEM_PRECISIONS=float -DBULLETFEM_UNITY=8 -DBULLETFEM_WITH_SUITESPARSE=OFF -DBULLETFEM_WITH_METIS=OFF
    -DBULLETFEM_WITH_TBB=OFF -DBULLETFEM_VECTORS=static -DBULLETFEM_PRECOMPILE=OFF -DBULLETFEM_BUILD_TOOLS=OFF
    -DBULLETFEM_BUILD_DEMOS=OFF -DBULLETFEM_BUILD_BENCHMARKS=OFF -DBULLETFEM_BUILD_PICTURES=OFF)
