#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# format.sh [--fix]: checks that clang-format 14 leaves all .h and .cpp unchanged; --fix formats them.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
mode=(--dry-run --Werror)
case ${1-} in
"") ;;
--fix) mode=(-i) ;;
*) fail "format.sh: $1 is not --fix" ;;
esac

is_available clang-format-14 clang-format-14 || exit 0
mapfile -t files < <(files_of_project | grep -E '\.(h|cpp)$')
(cd "$root" && printf '%s\0' "${files[@]}" | xargs -0 clang-format-14 "${mode[@]}") ||
    fail "these lines are not as clang-format 14 writes them: tools/ci/format.sh --fix"
say "${#files[@]} files: formatted"
