// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <cmath>

#include "fem/factor/dense_kernels.h"

namespace bullet_fem
{

int eliminatePivotsPlain(const DenseFront& front, double& pivotValue)
{
    const int p = front.m_pivots, r = front.m_rows, size = p + r;
    // The lower half of the whole front, by its blocks.
    const auto at = [&](int i, int j) -> double&
    {
        if (j >= p) return front.m_A22[(i - p) + static_cast<std::size_t>(j - p) * r];
        if (i >= p) return front.m_A21[(i - p) + static_cast<std::size_t>(j) * r];
        return front.m_A11[i + static_cast<std::size_t>(j) * p];
    };
    const auto symmetric = [&](int i, int j) -> double& { return i >= j ? at(i, j) : at(j, i); };
    for (int k = 0; k < p; ++k)
    {
        const double pivot = pivotValue = at(k, k);
        if (!(pivot > 0 && std::isfinite(pivot))) return k;
        for (int j = 0; j < size; ++j)
            for (int i = j; i < size; ++i)
                if (i != k && j != k) at(i, j) -= symmetric(i, k) * symmetric(j, k) / pivot;
        for (int i = 0; i < size; ++i) symmetric(i, k) /= pivot;
        at(k, k) = -1 / pivot;
    }
    for (int j = 0; j < p; ++j)
        for (int i = j; i < p; ++i) at(i, j) = front.m_A11[j + static_cast<std::size_t>(i) * p] = -at(i, j);
    return -1;
}

void subtractProductPlain(const DenseProduct& p)
{
    for (int j = 0; j < p.m_n; ++j)
        for (int i = p.m_lowerOnly ? j : 0; i < p.m_m; ++i)
            for (int k = 0; k < p.m_k; ++k)
                p.m_C[i + static_cast<std::ptrdiff_t>(j) * p.m_strideC] -=
                    p.m_U[i + static_cast<std::ptrdiff_t>(k) * p.m_strideU] *
                    p.m_V[j + static_cast<std::ptrdiff_t>(k) * p.m_strideV];
}

}  // namespace bullet_fem
