// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

namespace bullet_fem
{

/// Three rows of numbers, the first at m_first.
struct RowTriple
{
    const double* m_first = nullptr;
    std::size_t m_stride = 0;
};

/// block[3 c + d] -= sum over k < count of a_c[k] b_d[k]: what factors by rows are made of. On the widest vectors that
/// the processor has.
void subtractRowProducts(const RowTriple& a, const RowTriple& b, std::size_t count, double* block);

/// The same in plain C++: what the kernel is tested against.
namespace scalar
{
void subtractRowProducts(const RowTriple& a, const RowTriple& b, std::size_t count, double* block);
}  // namespace scalar

}  // namespace bullet_fem
