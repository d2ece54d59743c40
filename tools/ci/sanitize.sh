#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# sanitize.sh: the tests of fem and bullet_bridge under AddressSanitizer and UndefinedBehaviorSanitizer; with --quick
# without three suites that take a third of the time; with --python those of the Python module instead.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
build=$root/build/sanitized # separate from other scripts' build folders, because options differ
programs=(bulletfem_fem_test bulletfem_fem_threads_test bulletfem_elasticity_test bulletfem_baked_test
    bulletfem_bridge_test bulletfem_bridge_allocation_test bulletfem_bridge_pair_allocation_test)
labels='^(fem|elasticity|bridge)$'
options=()
left_out=Slow # suites of this name repeat others with finer meshes
case ${1-} in
"") ;;
--quick) left_out='Slow|Runaway|AssumedLawsOfBars|ElasticityAccurateBending' ;;
--python)
    programs=(bulletfem_python bulletfem_python_twin)
    labels='^python$'
    options=(-DBULLETFEM_PYTHON=ON -DPython_EXECUTABLE=/usr/bin/python3 -DBULLETFEM_PRECISIONS=float64
        -DBULLETFEM_VECTORS=static -DBULLETFEM_BUILD_SLOW_TESTS=OFF) # kernels for one instruction set, which are compiled sooner
    build=$build-python
    test_packages+=("${python_packages[@]}")
    ;;
*) fail "sanitize.sh: $1 is neither --quick nor --python" ;;
esac

install_for_build "${test_packages[@]}"

# LeakSanitizer needs ptrace, which some containers forbid.
probe=$(mktemp -d)
trap 'rm -r "$probe"' EXIT
echo 'int main() {}' >"$probe/probe.cpp"
"${CXX:-c++}" -fsanitize=address "$probe/probe.cpp" -o "$probe/probe" || fail "the compiler has no AddressSanitizer"
leaks=1
if ! ASAN_OPTIONS=detect_leaks=1 "$probe/probe" >/dev/null 2>&1; then
    leaks=0
    say "LeakSanitizer does not work in this container: leaks are not looked for"
fi

# Reports need only line numbers of -g, which saves a third of the time; -O1, and two instruction sets in place of four,
# halve the compile time of kernels each.
(cd "$root" && cmake --preset asan -B "$build" -DBULLETFEM_UNITY=8 "${options[@]}" \
    "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1 -DNDEBUG -DBULLETFEM_LEFT_OUT_TARGETS=HWY_SSE4+HWY_AVX3")
cmake --build "$build" --parallel "$(nproc)" --target "${programs[@]}"
export ASAN_OPTIONS=detect_leaks=$leaks:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1
BULLETFEM_TEST_SUITES=1 ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)" --exclude-regex "$left_out" \
    --label-regex "$labels" || fail "a sanitizer or a test finds the above: cmake --preset asan"
