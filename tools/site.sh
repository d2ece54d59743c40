#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# Builds docs/site/index.html by doxygen: the API reference, the documents and the examples, with search. Fails if a
# public name has no description or a link has no target.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/tools/ci/stages.sh"
is_available doxygen doxygen || exit 0
BULLETFEM_VERSION=$(sed -n 's/^project(BulletFEM VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
export BULLETFEM_VERSION
rm -rf "$root/docs/site"
mkdir -p "$root/docs/site"
(cd "$root" && doxygen docs/Doxyfile) || fail "doxygen finds the above"
[ -s "$root/docs/site/search/search.js" ] || fail "the site has no search"
say "docs/site/index.html: $(find "$root/docs/site" -name '*.html' | wc -l) pages"
