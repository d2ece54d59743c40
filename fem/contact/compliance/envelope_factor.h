// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// A symmetric positive semidefinite matrix of 3x3 blocks and its Cholesky factor W = L L^T, both stored by rows from
/// the first nonzero block on; L has no further fill [George & Liu 1981]. Linearly dependent unknowns, as of redundant
/// constraints, and held unknowns get the value 0, and the others are solved without them. Grows, never shrinks.
class EnvelopeFactor
{
public:
    /// A pivot below this share of its diagonal counts as zero, that is as a linearly dependent unknown; W is formed in
    /// single precision [-].
    static constexpr double kDependent = 1e-6;

    /// Reserves memory for this many rows, and this many blocks in total.
    void reserve(std::size_t rows, std::size_t blocks);

    /// Removes all rows.
    void clear();

    /// Appends a zero row with the first stored block `first`, in [0, its own index].
    void addRow(int first);

    int rows() const { return static_cast<int>(m_first.size()); }
    int first(int row) const { return m_first[row]; }

    /// Sets a block on or below the diagonal, first(i) <= j <= i.
    void set(int i, int j, const Mat3& block);

    /// Adds to an entry of such a block; each block row has three scalar rows.
    void add(int i, int j, double value)
    {
        const int row = i / 3;
        m_W[m_start[row] + (i % 3) * length(row) + static_cast<std::size_t>(j - 3 * m_first[row])] += value;
    }

    /// Factors; held[3 i + c] != 0 for unknowns that get the value 0.
    void factor(const unsigned char* held);

    /// x = W^-1 x, three values per row; 0 for held and dependent unknowns.
    void solve(double* x) const;

    /// Approximate number of multiplications for a row of this many blocks [-].
    static double work(double blocks) { return 4.5 * blocks * blocks; }

private:
    std::size_t length(int row) const { return 3 * static_cast<std::size_t>(row - m_first[row] + 1); }
    const double* rowOf(int i, int c) const { return &m_L[m_start[i] + c * length(i)]; }
    void subtractProducts(int i, int j, double* block) const;
    void factorDiagonal(int i, const unsigned char* held);

    std::vector<int> m_first;
    std::vector<std::size_t> m_start;  // per block row: start of its scalar rows
    std::size_t m_size = 0;            // number of entries in all rows
    std::vector<double> m_W, m_L;
    std::vector<double> m_inverse;  // per unknown: one over the diagonal of L, or 0
};

}  // namespace bullet_fem
