#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# Installs missing packages (Debian 12, as root or with sudo), builds and runs the benchmarks, writes their results to
# out/benchmarks/, and updates the tables and pictures of docs/performance.md, accuracy.md and materials.md.
#
#   benchmarks/run.sh                     all, small: about two minutes
#   benchmarks/run.sh --full              all, as in docs/performance.md: ten minutes to an hour
#   benchmarks/run.sh --full beam curve   a selection of beam curve kernels factors scaling contact copies
#                                         crowd games materials motion stiffness
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/cmake/install_packages.sh"

build=$root/build/benchmarks # separate from the build folders of other scripts, because options differ
out=$root/out/benchmarks
known=(beam curve kernels factors scaling contact copies crowd games materials motion stiffness)
full=0
chosen=()
for argument in "$@"; do
    case $argument in
        --full) full=1 ;;
        -h | --help)
            sed -n '3,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
            exit 0
            ;;
        *)
            [[ " ${known[*]} " == *" $argument "* ]] || fail "$argument is not --full or one of: ${known[*]}"
            chosen+=("$argument")
            ;;
    esac
done
[ ${#chosen[@]} -gt 0 ] || chosen=("${known[@]}")

# run <program> <file> <options when quick> <options when full>: writes results to <file>.json, tables to <file>.txt.
run()
{
    local options=$3
    [ "$full" -eq 0 ] || options=$4
    say "$1 $options"
    # shellcheck disable=SC2086
    "$build/benchmarks/bulletfem_bench_$1" $options --json "$out/$2.json" | tee "$out/$2.txt"
}

run_benchmark()
{
    case $1 in
        beam) run beam beam "--steps 20" "" ;;
        curve) run beam curve "--curve --tets 1536 --young 1e6 --steps 20" "--curve --tets 12288 --young 1e6" ;;
        kernels)
            run kernels kernels "--tets 1536,12288 --seconds 0.2" "--tets 1536,5184,12288,24000,41472,98304 --seconds 1"
            ;;
        factors)
            run kernels factors "--tets 192 --factors 1500 --seconds 0.1" \
                "--tets 192 --factors 1500,13000,48000 --fill --seconds 1"
            ;;
        scaling) run scaling scaling "--tets 192,1536,12288 --steps 20" "--large --steps 30" ;;
        contact)
            run contact contact "--quick" "--scenes block,ball --contacts 10,100 --tets 1000,5000"
            ;;
        games) run games games "--share 0.2" "" ;;
        motion) run motion motion "--rates 30,60,120 --reference 240 --cells 6" "" ;;
        materials) run materials materials "" "" ;;
        stiffness) run stiffness stiffness "--young 1e4,1e7,1e9 --edges 0.001,0.1" "" ;;
        copies) run crowd copies "--free" "--free" ;;
        crowd)
            local small="--bodies 10 --balls 2 --settle 0.3 --steps 10 --awake-only"
            local rest="--settle 6 --steps 60 --awake-only --threads 2"
            run crowd crowd_swap "$small" "$rest"
            run crowd crowd_400 "--bodies 20 ${small#--bodies 10}" "--bodies 400 --balls 80 $rest"
            run crowd crowd_different "$small --different" "$rest --different"
            run crowd crowd_cubes "$small --cubes" "$rest --cubes"
            run crowd crowd_coupled "$small --coupled" "--bodies 30 --balls 6 $rest --coupled"
            ;;
    esac
}

# CHOLMOD is slow with the reference BLAS, which is installed with it.
install_packages "${build_packages[@]}" libopenblas0-serial nlohmann-json3-dev python3 python3-matplotlib

say "building in $build"
(cd "$root" && cmake --preset release -B "$build" -DBULLETFEM_BUILD_TESTS=OFF -DBULLETFEM_BUILD_DEMOS=OFF)
cmake --build "$build" --parallel "$(nproc)"

mkdir -p "$out"
for name in "${chosen[@]}"; do run_benchmark "$name"; done

# Debian's interpreter, which finds Debian's matplotlib, whichever python3 comes first in PATH.
python=/usr/bin/python3
[ -x "$python" ] || python=python3
say "renewing docs/performance.md"
"$python" "$root/tools/performance_tables.py" "$out" "$root/docs/performance.md"
if [ -s "$out/curve.json" ]; then
    "$python" "$root/tools/plot_error_against_time.py" "$out/curve.json" "$root/docs/error_against_time.png"
fi
if [ "$full" -eq 1 ] && [ -s "$out/motion.json" ]; then
    "$python" "$root/tools/plot_motion_against_step.py" "$out/motion.json" "$root/docs/motion_against_step.png"
    "$python" "$root/tools/plot_rebound.py" "$out/motion.json" "$root/docs/rebound_against_stiffness.png"
fi
if [ -s "$out/materials.json" ]; then
    "$python" "$root/tools/plot_materials.py" "$out/materials.json" "$root/docs/materials.png"
fi
