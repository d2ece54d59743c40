#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# debs.sh [--quick]: builds Debian packages in build/debs: libraries, development files and tools; Lintian must find no
# error. Then installs them in a minimal Debian 12 (mmdebstrap, as root, from the mirror), and builds and runs README's
# program there. --quick: single precision only.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
build=$root/build/debs
precisions="float;float64"
case ${1-} in
"") ;;
--quick) precisions=float ;;
*) fail "debs.sh: $1 is not --quick" ;;
esac
install_for_build lintian mmdebstrap dpkg-dev file

say "building the packages in $build"
mkdir -p "$build"
cmake -S "$root" -B "$build" -DBULLETFEM_BUILD_DEBS=ON -DBUILD_SHARED_LIBS=ON -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_INSTALL_LIBDIR="lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)" \
    -DCMAKE_INSTALL_DOCDIR=share/doc/libbulletfem-dev -DBULLETFEM_PRECISIONS="$precisions" -DBULLETFEM_UNITY=8 \
    -DBULLETFEM_BUILD_TESTS=OFF -DBULLETFEM_BUILD_DEMOS=OFF -DBULLETFEM_BUILD_BENCHMARKS=OFF \
    -DBULLETFEM_BUILD_PICTURES=OFF >"$build.log" 2>&1 || { cat "$build.log"; fail "cannot configure"; }
cmake --build "$build" --parallel "${JOBS:-$(nproc)}" >>"$build.log" 2>&1 || { tail -40 "$build.log"; fail "see $build.log"; }
rm -f "$build"/*.deb
(cd "$build" && cpack >>"$build.log" 2>&1) || { tail -40 "$build.log"; fail "cpack: see $build.log"; }
packages=("$build"/*.deb)
for package in "${packages[@]}"; do
    say "$(basename "$package"), $(($(stat -c %s "$package") / 1024)) KiB: $(dpkg-deb -f "$package" Depends)"
done
lintian --allow-root --fail-on error "${packages[@]}"

program=$build/program # the first program of README
rm -rf "$program"
mkdir -p "$program"
cp "$root"/demos/hello/* "$program"

if [ "$(id -u)" -ne 0 ]; then
    say "left out: only root can install the packages in a Debian of its own"
    exit 0
fi
say "installing them in a Debian 12 of its own"
cp "${packages[@]}" "$program"
chroot_log=$build/chroot.log
# shellcheck disable=SC2016
install_inside='chroot "$1" sh -ec "apt-get install --yes --no-install-recommends /program/*.deb"'
# shellcheck disable=SC2016
run_inside='chroot "$1" sh -ec "cd /program && cmake -B build . && cmake --build build && build/hello && bulletfem --version"'
# The commands inside print a line that is required in the output, so that a missing run is detected.
if ! mmdebstrap --variant=minbase --mode=root --include=g++,cmake,make \
    --customize-hook="mkdir \"\$1/program\" && cp -r '$program/.' \"\$1/program\"" \
    --customize-hook="$install_inside" --customize-hook="$run_inside" \
    bookworm /dev/null >"$chroot_log" 2>&1; then
    tail -30 "$chroot_log"
    fail "see $chroot_log"
fi
grep -E 'contact force 704[.]0 N' "$chroot_log" || fail "the program did not run: see $chroot_log"
built "GCC $(g++ -dumpfullversion)" C++17 "$(bullet_version /usr/include/bullet)" "${precisions/;/, }" "$(system_of_build)" \
    "Debian packages; the README's program runs with them"
