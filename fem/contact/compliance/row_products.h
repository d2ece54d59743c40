// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

namespace bullet_fem
{

/// Three scalar rows, the first at m_first.
struct RowTriple
{
    const double* m_first = nullptr;
    std::size_t m_stride = 0;
};

/// block[3 c + d] -= sum over k < count of a_c[k] b_d[k], the inner product of row-oriented factorization. On the
/// widest vectors of the processor.
void subtractRowProducts(const RowTriple& a, const RowTriple& b, std::size_t count, double* block);

/// Reference in plain C++, against which the kernel is tested.
namespace scalar
{
void subtractRowProducts(const RowTriple& a, const RowTriple& b, std::size_t count, double* block);
}  // namespace scalar

}  // namespace bullet_fem
