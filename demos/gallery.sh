#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# gallery.sh [--docs] [demo | scene]...: installs missing packages (Debian 12, as root or with sudo), builds and runs
# the demos of the gallery and the scenes on materials, all or the named ones, and writes results, three pictures and a
# film of each to out/gallery/.
# --docs: also writes the small films of docs/gallery.md and docs/materials.md to docs/gallery/.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/cmake/install_packages.sh"
source "$root/cmake/mesh_package.sh"

most_bytes=1000000         # limit of a film in docs/gallery
most_bytes_compare=1500000 # limit of the film on README's first screen
mesh_in_archive=data/meshes/elephant.off
build=$root/build/gallery # separate from other scripts' build folders, because options differ
into_docs=no
material_scenes=(bending crush locking plate relax) # demos/scenes/<name>.json, in docs/materials.md
demos=()
for word in "$@"; do
    case $word in
    --docs) into_docs=yes ;;
    -*) fail "gallery.sh: $word is not --docs" ;;
    *) [ -f "$root/demos/$word/$word.cpp" ] || [ -f "$root/demos/scenes/$word.json" ] ||
        fail "there is no demo or scene $word: see demos/*/ and demos/scenes/"
       demos+=("$word") ;;
    esac
done
if [ ${#demos[@]} -eq 0 ]; then
    for source in "$root"/demos/*/; do
        name=$(basename "$source")
        [ ! -f "$source/$name.cpp" ] || demos+=("$name")
    done
    demos+=("${material_scenes[@]}")
fi
targets=()
for demo in "${demos[@]}"; do
    if [ -f "$root/demos/$demo/$demo.cpp" ]; then targets+=("bulletfem_demo_$demo"); else targets+=(bulletfem); fi
done

install_packages "${build_packages[@]}" "${picture_packages[@]}" ffmpeg gifsicle
if [ ! -s "$build/$mesh_in_archive" ]; then
    say "extracting $mesh_in_archive from $mesh_package"
    extract_meshes "$build" "$mesh_in_archive" || fail "cannot get $mesh_in_archive from the package $mesh_package"
fi

say "building in $build"
(cd "$root" && cmake --preset release -B "$build" -DBULLETFEM_UNITY=8 -DBULLETFEM_PRECISIONS=float \
    -DBULLETFEM_BUILD_TESTS=OFF -DBULLETFEM_BUILD_BENCHMARKS=OFF)
cmake --build "$build" --target "${targets[@]}" --parallel "$(nproc)"

# end_of_motion <film>: half a second after the last picture that differs from the previous one [s]; empty if the motion
# lasts to the end.
end_of_motion()
{
    ffmpeg -hide_banner -nostats -i "$1" -vf freezedetect=noise=0.0006:duration=0.5 -f null - 2>&1 |
        awk '/freeze_start/ { end = $NF + 0.5 } /freeze_end/ { end = "" } END { print end }'
}

# shrink <film> <GIF> <size> <colours> <loss>: makes a film for documents, which ends with the motion.
shrink()
{
    local end
    end=$(end_of_motion "$1")
    ffmpeg -loglevel error -y -i "$1" ${end:+-t "$end"} -map_metadata -1 -vf "fps=10,hqdn3d=2:2:4:4,\
scale=$3:flags=area,split[a][b];[a]palettegen=max_colors=$4:stats_mode=full[p];[b][p]paletteuse=dither=none" "$2"
    gifsicle --batch --optimize=3 --lossy="$5" "$2"
}

# play <demo or scene>: runs it, and makes a small film for documents from the large one.
play()
{
    local demo=$1 out=$root/out/gallery/$1 options=() look=(480:270 64 40)
    case $demo in
    compare) options=(--mesh "$build/$mesh_in_archive") look=(800:450 128 10) ;;
    squeeze) options=(--mesh "$build/$mesh_in_archive") ;;
    esac
    mkdir -p "$out"
    local program=("$build/demos/bulletfem_demo_$demo" --out "$out" "${options[@]}")
    if [ ! -f "$root/demos/$demo/$demo.cpp" ]; then
        program=("$build/tools/bulletfem/bulletfem" simulate "$root/demos/scenes/$demo.json" --png --film film.mp4 \
            --quiet --out "$out")
    fi
    "${program[@]}" >"$out/figures.txt" 2>&1 || { cat "$out/figures.txt"; return 1; }
    shrink "$out/film.mp4" "$out/$demo.gif" "${look[@]}"
    cat "$out/figures.txt"
}

failed=()
for ((k = 0; k < ${#demos[@]}; k += 2)); do # two in parallel
    running=()
    for demo in "${demos[@]:k:2}"; do
        say "playing $demo"
        play "$demo" &
        running+=("$!:$demo")
    done
    for job in "${running[@]}"; do wait "${job%%:*}" || failed+=("${job#*:}"); done
done
[ ${#failed[@]} -eq 0 ] || fail "these failed, see above: ${failed[*]}"

for demo in "${demos[@]}"; do
    film=$root/out/gallery/$demo/$demo.gif
    bytes=$(stat -c %s "$film") most=$most_bytes
    [ "$demo" != compare ] || most=$most_bytes_compare
    [ "$bytes" -le "$most" ] || fail "$film has $bytes bytes, at most $most are allowed in documents"
    [ $into_docs = no ] || cp "$film" "$root/docs/gallery/"
done
say "figures, pictures and films are in $root/out/gallery"
