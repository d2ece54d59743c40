# SPDX-License-Identifier: Zlib
# shellcheck shell=bash disable=SC2034
# Sourced by demos/run.sh and tests/run.sh: installs Debian packages that are missing.

# Needed by each build of this project.
build_packages=(g++ cmake ninja-build libbullet-dev libeigen3-dev libhwy-dev libtbb-dev libsuitesparse-dev libmetis-dev
    libassimp-dev libxxhash-dev libtinyxml2-dev zlib1g-dev libtinygltf-dev nlohmann-json3-dev libcli11-dev)

# Needed for pictures and the window; without them the build leaves both out. The last two are OpenGL's software driver.
picture_packages=(pkg-config libepoxy-dev libegl-dev libstb-dev fonts-dejavu-core libglfw3-dev libimgui-dev libgl1
    libegl-mesa0 libgl1-mesa-dri)

# Needed for the Python module and its tests.
python_packages=(python3-dev pybind11-dev python3-pybind11 python3-numpy python3-pytest mypy)

say() { printf '== %s\n' "$*"; }
fail() { printf 'error: %s\n' "$*" >&2; exit 1; }

# as_root <command>...: runs the command as root, through sudo if necessary.
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

# install_packages <package>...: installs missing packages; does nothing if none is missing.
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
