#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# threads.sh: what uses threads, under ThreadSanitizer: the tests of it of every library, and a minute of random programs.
# Debian's METIS and AMD are not built for it; what they do is seen by what they call of the C library alone.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/tools/ci/stages.sh"
build=$root/build/threads # of its own, so that no script changes the options of another's
programs=(fem elasticity actuation bridge threads policy accurate_bending breaking cloth regions skin torsional_friction tools)
filter='*hread*:*Shared*:*Batch*:*Concurrent*:*FactorJobs*:*BackgroundRefactoring*:*MeshLoading*'
soaked=60 # s

install_for_build "${test_packages[@]}"

# Kernels for one kind of vectors: threads do not depend on it, and each further one is compiled as long again.
(cd "$root" && cmake --preset tsan -B "$build" -DBULLETFEM_UNITY=8 -DBULLETFEM_PRECISIONS=float -DBULLETFEM_VECTORS=static \
    -DBULLETFEM_BUILD_PICTURES=OFF "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O2 -g1 -DNDEBUG")
cmake --build "$build" --parallel "$(nproc)" --target "${programs[@]/%/_test}" bulletfem_soak
export TSAN_OPTIONS=halt_on_error=1
