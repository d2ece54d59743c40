# SPDX-License-Identifier: Zlib
# shellcheck shell=bash disable=SC2034,SC2154
# Sourced by .ci/run and the scripts in this folder, which set root.
source "$root/cmake/install_packages.sh"

# Packages for the stages besides build_packages and those that tests/run.sh installs.
test_packages=(libgtest-dev libgmock-dev)
check_packages=(git clang-format-14 clang-tidy-14 shellcheck python3)

# is_available <command> <package>: true if the command exists. A missing one is installed; without apt a message is
# printed.
is_available()
{
    command -v "$1" >/dev/null && return
    if ! command -v apt-get >/dev/null; then
        say "left out: there is no $1, and no apt-get to install Debian's $2"
        return 1
    fi
    install_packages "$2" || fail "apt-get cannot install $2"
    command -v "$1" >/dev/null || fail "$2 brings no $1"
}

# in_git <argument>...: runs git in this tree, regardless of its owner.
in_git() { git -C "$root" -c "safe.directory=$root" "$@"; }

# install_for_build <package>...: installs the packages of each build, and these.
install_for_build()
{
    if command -v apt-get >/dev/null; then
        install_packages "${build_packages[@]}" "$@"
    else
        say "there is no apt-get: what the build needs must be there already"
    fi
}

# files_of_project: paths of all files known to git or, outside a git repository, of all files.
files_of_project()
{
    if in_git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
        in_git ls-files --cached --others --exclude-standard --deduplicate | while IFS= read -r path; do
            [ ! -e "$root/$path" ] || printf '%s\n' "$path"
        done
    else
        (cd "$root" && find . -path ./build -prune -o -path ./out -prune -o -type f -printf '%P\n')
    fi
}

# built <compiler> <standard> <Bullet> <precision> <system> <result>: prints the result; with RECORD=1 in the
# environment also writes it to docs/compatibility.md.
built()
{
    if [ "${RECORD-}" = 1 ]; then
        python3 "$root/tools/ci/built.py" "$@"
    else
        printf '%s  %s  %s  %s  %s  %s\n' "$@"
    fi
}

# bullet_version <headers>: e.g. 3.24
bullet_version()
{
    sed -n 's/^#define BT_BULLET_VERSION \([0-9]\)\([0-9]*\).*/\1.\2/p' "$1/LinearMath/btScalar.h"
}

# system_of_build: e.g. Debian 12, x86-64
system_of_build()
{
    printf '%s, %s\n' "$(. /etc/os-release && printf '%s %s' "${NAME%% *}" "${VERSION_ID-}")" "$(uname -m | tr _ -)"
}

# The commit to which a change is compared: the branch point from origin/main, or the last commit but one; empty in a
# clone of one commit.
base_commit()
{
    local head base
    head=$(in_git rev-parse --verify --quiet HEAD) || return 0
    base=$(in_git merge-base HEAD origin/main 2>/dev/null || true)
    [ -n "$base" ] && [ "$base" != "$head" ] || base=$(in_git rev-parse --verify --quiet HEAD~1 || true)
    printf '%s' "$base"
}

# changed_files <commit>: paths that differ from it, including new files.
changed_files()
{
    in_git diff --name-only --diff-filter=d "$1"
    in_git ls-files --others --exclude-standard
}
