// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// A symmetric, positive semi-definite matrix of 3x3 blocks, and its Cholesky factor W = L L^T, both stored row by row
/// from the first block that is not zero on: L has no others [George & Liu 1981]. An unknown that hangs on those before
/// it, as that of a constraint given twice does, or that is held, gets no answer, and the others are solved as if it
/// were not there. Grows, never shrinks.
class EnvelopeFactor
{
public:
    /// A pivot below this share of its diagonal is that of an unknown that hangs on others: what single precision, in
    /// which W is formed, leaves of a zero [-].
    static constexpr double kDependent = 1e-6;

    /// Makes room for so many rows, and so many blocks in all of them.
    void reserve(std::size_t rows, std::size_t blocks);

    /// Forgets all rows.
    void clear();

    /// The next row, whose first block that is not zero is `first`, in [0, its own number]. Its blocks are zero.
    void addRow(int first);

    int rows() const { return static_cast<int>(m_first.size()); }
    int first(int row) const { return m_first[row]; }

    /// Sets a block on or below the diagonal, first(i) <= j <= i.
    void set(int i, int j, const Mat3& block);

    /// Adds to a number in such a block: three a row.
    void add(int i, int j, double value)
    {
        const int row = i / 3;
        m_W[m_start[row] + (i % 3) * length(row) + static_cast<std::size_t>(j - 3 * m_first[row])] += value;
    }

    /// Factors; held[3 i + c] != 0 for unknowns that get no answer.
    void factor(const unsigned char* held);

    /// x = W^-1 x, three values a row; 0 of those without an answer.
    void solve(double* x) const;

    /// Multiplications that factoring a row of so many blocks takes, roughly [-].
    static double work(double blocks) { return 4.5 * blocks * blocks; }

private:
    std::size_t length(int row) const { return 3 * static_cast<std::size_t>(row - m_first[row] + 1); }
    const double* rowOf(int i, int c) const { return &m_L[m_start[i] + c * length(i)]; }
    void subtractProducts(int i, int j, double* block) const;
    void factorDiagonal(int i, const unsigned char* held);

    std::vector<int> m_first;
    std::vector<std::size_t> m_start;  // per row: of its three rows of numbers
    std::size_t m_size = 0;            // numbers in all rows
    std::vector<double> m_W, m_L;
    std::vector<double> m_inverse;  // per unknown: one over the diagonal of L, or 0
};

}  // namespace bullet_fem
