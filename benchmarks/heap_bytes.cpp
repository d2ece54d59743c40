// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/heap_bytes.h"

#include <cstdlib>

#if defined(__GLIBC__)
#if __GLIBC_PREREQ(2, 33)
#define BULLETFEM_HAS_MALLINFO2
#include <malloc.h>
#endif
#endif

namespace bullet_fem
{

std::size_t heapBytes()
{
#ifdef BULLETFEM_HAS_MALLINFO2
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;  // small blocks, and large blocks with a mapping of their own
#else
    return 0;
#endif
}

}  // namespace bullet_fem
