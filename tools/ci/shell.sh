#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# shell.sh: checks that all shell scripts parse and shellcheck reports no finding.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"

cd "$root"
scripts=()
while IFS= read -r path; do
    case $path in
    *.sh) scripts+=("$path") ;;
    *.*) ;;
    *) if head -c 64 "$path" | head -n 1 | grep -qaE '^#!.*\b(ba)?sh\b'; then scripts+=("$path"); fi ;;
    esac
done < <(files_of_project)
case " ${scripts[*]} " in *" .ci/run "*) ;; *) scripts+=(.ci/run) ;; esac

for script in "${scripts[@]}"; do
    bash -n "$script" || fail "$script does not parse"
done
if is_available shellcheck shellcheck; then
    shellcheck --external-sources "${scripts[@]}" || fail "shellcheck finds the above"
fi
say "${#scripts[@]} scripts: nothing found"
