// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/envelope_factor.h"

#include <algorithm>
#include <cmath>

#include "fem/contact/compliance/row_products.h"

namespace bullet_fem
{
namespace
{

// Number of independent partial sums.
double rowProduct(const double* a, const double* b, std::size_t count)
{
    constexpr std::size_t kSums = 8;
    double sums[kSums] = {};
    std::size_t k = 0;
    for (; k + kSums <= count; k += kSums)
        for (std::size_t s = 0; s < kSums; ++s) sums[s] += a[k + s] * b[k + s];
    for (; k < count; ++k) sums[0] += a[k] * b[k];
    return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}

}  // namespace

void EnvelopeFactor::reserve(std::size_t rows, std::size_t blocks)
{
    m_first.reserve(rows);
    m_start.reserve(rows);
    m_inverse.reserve(3 * rows);
    if (m_W.size() >= 9 * blocks) return;
    m_W.resize(9 * blocks);
    m_L.resize(9 * blocks);
}

void EnvelopeFactor::clear()
{
    m_first.clear();
    m_start.clear();
    m_size = 0;
}

void EnvelopeFactor::addRow(int first)
{
    m_first.push_back(first);
    m_start.push_back(m_size);
    m_size += 3 * length(rows() - 1);
    if (m_W.size() < m_size)
    {
        m_W.resize(m_size);
        m_L.resize(m_size);
    }
    std::fill(m_W.begin() + static_cast<std::ptrdiff_t>(m_start.back()),
              m_W.begin() + static_cast<std::ptrdiff_t>(m_size), 0.0);
}

void EnvelopeFactor::set(int i, int j, const Mat3& block)
{
    double* at = &m_W[m_start[i] + 3 * static_cast<std::size_t>(j - m_first[i])];
    for (int c = 0; c < 3; ++c, at += length(i))
        for (int d = 0; d < 3; ++d) at[d] = block(c, d);
}

// Product of two rows of L over their common columns left of block j.
void EnvelopeFactor::subtractProducts(int i, int j, double* block) const
{
    const int first = std::max(m_first[i], m_first[j]);
    const auto from = [&](int row) -> RowTriple {
        return {rowOf(row, 0) + 3 * static_cast<std::size_t>(first - m_first[row]), length(row)};
    };
    subtractRowProducts(from(i), from(j), 3 * static_cast<std::size_t>(j - first), block);
}

void EnvelopeFactor::factor(const unsigned char* held)
{
    m_inverse.resize(3 * m_first.size());
    for (int i = 0; i < rows(); ++i)
    {
        const std::size_t stride = length(i);
        for (int j = m_first[i]; j <= i; ++j)
        {
            const std::size_t at = m_start[i] + 3 * static_cast<std::size_t>(j - m_first[i]);
            double block[9];
            for (int e = 0; e < 9; ++e) block[e] = m_W[at + (e / 3) * stride + e % 3];
            subtractProducts(i, j, block);
            if (j < i)
                for (int c = 0; c < 3; ++c)
                    for (int d = 0; d < 3; ++d)
                    {
                        const double* pivots = rowOf(j, d) + length(j) - 3;
                        for (int k = 0; k < d; ++k) block[3 * c + d] -= block[3 * c + k] * pivots[k];
                        block[3 * c + d] *= m_inverse[3 * static_cast<std::size_t>(j) + d];
                    }
            for (int e = 0; e < 9; ++e) m_L[at + (e / 3) * stride + e % 3] = block[e];
        }
        factorDiagonal(i, held + 3 * static_cast<std::size_t>(i));
    }
}

// Factors the diagonal block of a row, which holds W minus the products.
void EnvelopeFactor::factorDiagonal(int i, const unsigned char* held)
{
    const std::size_t stride = length(i), own = stride - 3;
    for (std::size_t d = 0; d < 3; ++d)
    {
        double* row = &m_L[m_start[i] + d * stride + own];
        for (std::size_t k = 0; k < d; ++k)
        {
            const double* other = &m_L[m_start[i] + k * stride + own];
            for (std::size_t l = 0; l < k; ++l) row[k] -= row[l] * other[l];
            row[k] *= m_inverse[3 * static_cast<std::size_t>(i) + k];
            row[d] -= row[k] * row[k];
        }
        const double whole = m_W[m_start[i] + d * stride + own + d];
        const bool answers = !held[d] && row[d] > kDependent * whole;
        m_inverse[3 * static_cast<std::size_t>(i) + d] = answers ? 1 / std::sqrt(row[d]) : 0;
    }
}

void EnvelopeFactor::solve(double* x) const
{
    for (int i = 0; i < rows(); ++i)
        for (int c = 0; c < 3; ++c)
        {
            const double *row = rowOf(i, c), *known = x + 3 * static_cast<std::size_t>(m_first[i]);
            const std::size_t count = length(i) - 3 + c;
            double& value = x[3 * static_cast<std::size_t>(i) + c];
            value = (value - rowProduct(row, known, count)) * m_inverse[3 * static_cast<std::size_t>(i) + c];
        }
    for (int i = rows() - 1; i >= 0; --i)
        for (int c = 2; c >= 0; --c)
        {
            const double* row = rowOf(i, c);
            double* others = x + 3 * static_cast<std::size_t>(m_first[i]);
            const std::size_t count = length(i) - 3 + c;
            const double value = x[3 * static_cast<std::size_t>(i) + c] *=
                m_inverse[3 * static_cast<std::size_t>(i) + c];
            for (std::size_t k = 0; k < count; ++k) others[k] -= row[k] * value;
        }
}

}  // namespace bullet_fem
