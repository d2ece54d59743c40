# SPDX-License-Identifier: Zlib
# shellcheck shell=bash disable=SC2034
# Sourced by demos/run.sh and tests/run.sh: Debian packages, installed only if they are missing.

# What every build of this project needs.
build_packages=(g++ cmake ninja-build libbullet-dev libeigen3-dev libhwy-dev libtbb-dev libsuitesparse-dev libmetis-dev
    libassimp-dev libxxhash-dev libtinyxml2-dev zlib1g-dev libtinygltf-dev nlohmann-json3-dev libcli11-dev)

# What pictures and the window need; the build leaves them out without these. The last two are the software driver for OpenGL.
picture_packages=(pkg-config libepoxy-dev libegl-dev libstb-dev fonts-dejavu-core libglfw3-dev libimgui-dev libgl1
    libegl-mesa0 libgl1-mesa-dri)

say() { printf '== %s\n' "$*"; }
fail() { printf 'error: %s\n' "$*" >&2; exit 1; }

# as_root <command>...: runs it as root, through sudo if need be.
as_root()
{
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        fail "this must be run as root, and there is no sudo: $*"
    fi
}

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# install_packages <package>...: installs those that are missing, and touches nothing if none is.
install_packages()
{
    local missing=() package
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        fail "apt-get not found: install by hand what these Debian packages hold, then use cmake --preset release: $*"
    fi
    for package in "$@"; do
        is_installed "$package" || missing+=("$package")
    done
    if [ ${#missing[@]} -eq 0 ]; then
        say "all packages are installed"
        return
    fi
    say "installing ${missing[*]}"
    as_root apt-get update
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "${missing[@]}"
}
