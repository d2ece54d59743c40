// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

/// Counts heap allocations of the whole program since its construction: operator new, malloc, calloc, realloc and the
/// aligned ones, by any caller. Under a sanitizer, which owns malloc, and without glibc, it counts operator new only.
/// Linking this library replaces those functions. Thread-safe.
class AllocationCounter
{
public:
    AllocationCounter();

    /// Allocations since construction [-]; releases do not count.
    long count() const;

    /// True if malloc and its relatives are counted, not operator new alone.
    static bool countsMalloc();

private:
    long m_start;
};

}  // namespace bullet_fem
