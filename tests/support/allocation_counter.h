// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

/// Counts heap allocations of the whole program from its construction on: operator new, and malloc, calloc, realloc and
/// the aligned ones under whatever calls them. Under a sanitizer, which owns malloc, and without glibc, operator new
/// alone. Linking the library that holds it replaces those functions. Thread-safe.
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
