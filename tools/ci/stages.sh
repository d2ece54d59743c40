# SPDX-License-Identifier: Zlib
# shellcheck shell=bash disable=SC2034,SC2154
# Sourced by .ci/run and the scripts beside this one, which have set root.
source "$root/cmake/install_packages.sh"

# What the stages need beside build_packages and what tests/run.sh installs itself.
test_packages=(libgtest-dev libgmock-dev)
check_packages=(git clang-format-14 clang-tidy-14 shellcheck python3)

# is_available <command> <package>: true if there is the command. It is installed if it is missing; where there is no apt
# for that, a sentence says so.
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

# in_git <argument>...: git, in this tree, whoever owns it.
in_git() { git -C "$root" -c "safe.directory=$root" "$@"; }

# install_for_build <package>...: what every build needs, and these.
install_for_build()
{
    if command -v apt-get >/dev/null; then
        install_packages "${build_packages[@]}" "$@"
    else
        say "there is no apt-get: what the build needs must be there already"
    fi
}

# files_of_project: the paths of all files that git knows, or, outside of git, of all that are there.
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

# built <compiler> <standard> <Bullet> <precision> <system> <result>: prints it; with RECORD=1 in the environment it goes to
# docs/compatibility.md, too.
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

# The commit that a change is compared with: where this branch left origin/main, or the last commit but one; nothing in a
# clone of one commit.
base_commit()
{
    local head base
    head=$(in_git rev-parse --verify --quiet HEAD) || return 0
    base=$(in_git merge-base HEAD origin/main 2>/dev/null || true)
    [ -n "$base" ] && [ "$base" != "$head" ] || base=$(in_git rev-parse --verify --quiet HEAD~1 || true)
    printf '%s' "$base"
}

# changed_files <commit>: paths that differ from it, new ones too.
changed_files()
{
    in_git diff --name-only --diff-filter=d "$1"
    in_git ls-files --others --exclude-standard
}
