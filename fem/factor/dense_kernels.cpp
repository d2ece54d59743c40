// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The sweep operator [Goodnight 1979] eliminates pivots. Sweeping a symmetric A on the pivots k gives, for others i, j:
//     A_kk <- -A_kk^-1     A_ik <- A_ik A_kk^-1     A_ij <- A_ij - A_ik A_kk^-1 A_kj
// Sweeping on all pivots of A11, in blocks of any size, gives -A11^-1, A21 A11^-1 and A22 - A21 A11^-1 A21^T. The
// matrix stays symmetric throughout, so lower halves suffice, and nearly all work is one product, C -= U V^T.
#include "fem/factor/dense_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/factor/dense_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Shared by all targets, each of which includes this file once.
#ifndef BULLETFEM_DENSE_KERNELS_SHARED
#define BULLETFEM_DENSE_KERNELS_SHARED
namespace bullet_fem
{
// Pivots of a block at the outer level, where products should be long, and within such a block.
constexpr int kOuterBlock = 96;
constexpr int kInnerBlock = 12;

// Maximum rows of a panel, and alignment of starts to cache lines [doubles].
constexpr int kTallestPanel = 24;
constexpr int kAlignment = 8;
}  // namespace bullet_fem
#endif

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

const hn::CappedTag<double, 8> kTag;
using Vec = hn::Vec<decltype(kTag)>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(kTag));

// Size of a tile of C in vectors and columns, so that it fits in registers.
constexpr int kTileVectors = 3;
constexpr int kTileRows = kTileVectors * kLanes;
static_assert(kTileRows <= kTallestPanel);
constexpr int kTileColumns = HWY_MAX_BYTES >= 64 ? 8 : 4;

// One factor of a product, packed in panels of `width` rows in the order that tiles read them: for each of the k
// columns the panel's rows. The last panel is padded with zero rows.
struct Panels
{
    double* m_start;
    int m_rows, m_k, m_width;

    const double* panel(int row) const { return m_start + static_cast<std::size_t>(row) * m_k; }
    int roundedRows() const { return (m_rows + m_width - 1) / m_width * m_width; }
    double* end() const { return m_start + static_cast<std::size_t>(roundedRows()) * m_k; }
};

// A matrix in memory; entry (i, j) is m_start[i * m_rowStride + j * m_columnStride].
struct View
{
    const double* m_start;
    int m_rows, m_columns;
    std::ptrdiff_t m_rowStride, m_columnStride;
};

HWY_INLINE void packPanel(const View& X, int row, int count, int width, double* to)
{
    for (int k = 0; k < X.m_columns; ++k, to += width)
    {
        const double* from = X.m_start + row * X.m_rowStride + k * X.m_columnStride;
        for (int i = 0; i < count; ++i) to[i] = from[i * X.m_rowStride];
        for (int i = count; i < width; ++i) to[i] = 0;
    }
}

HWY_INLINE void packFullPanel(const View& X, int row, int width, double* to)
{
    const double* from = X.m_start + row;
    for (int k = 0; k < X.m_columns; ++k, to += width, from += X.m_columnStride)
        for (int i = 0; i < width; ++i) to[i] = from[i];
}

template <int kWidth>
Panels pack(const View& X, double* to)
{
    const Panels panels = {to, X.m_rows, X.m_columns, kWidth};
    for (int row = 0; row < X.m_rows; row += kWidth, to += static_cast<std::size_t>(kWidth) * X.m_columns)
        if (X.m_rowStride == 1 && row + kWidth <= X.m_rows)
            packFullPanel(X, row, kWidth, to);
        else
            packPanel(X, row, std::min(kWidth, X.m_rows - row), kWidth, to);
    return panels;
}

Panels packTall(const View& X, double* to)
{
    return pack<kTileRows>(X, to);
}
Panels packWide(const View& X, double* to)
{
    return pack<kTileColumns>(X, to);
}

// The destination of a product: column-major, all of it or the tiles on and below its diagonal.
struct Target
{
    double* m_start;
    std::ptrdiff_t m_stride;
    bool m_lowerOnly;
};

// Subtracts the first lanes from memory and accesses no others. (Masked loads may access others, and require aligned
// memory on SSE4.)
HWY_INLINE void subtractLanes(Vec x, int lanes, double* from)
{
    if (lanes == kLanes)
    {
        hn::StoreU(hn::Sub(hn::LoadU(kTag, from), x), kTag, from);
        return;
    }
    HWY_ALIGN double values[kLanes];
    hn::Store(x, kTag, values);
    for (int i = 0; i < lanes; ++i) from[i] -= values[i];
}

// C -= U V^T for the first `rows` rows and `columns` columns of one tile, rows in kVectors vectors.
template <int kVectors>
HWY_INLINE void subtractTile(const double* U, const double* V, int k, const Target& C, int rows, int columns)
{
    Vec sum[kTileColumns][kVectors];
#pragma GCC unroll 8
    for (int j = 0; j < kTileColumns; ++j)
#pragma GCC unroll 8
        for (int v = 0; v < kVectors; ++v) sum[j][v] = hn::Zero(kTag);
    for (int i = 0; i < k; ++i, U += kTileRows, V += kTileColumns)
    {
        Vec u[kVectors];
#pragma GCC unroll 8
        for (int v = 0; v < kVectors; ++v) u[v] = hn::LoadU(kTag, U + v * kLanes);
#pragma GCC unroll 8
        for (int j = 0; j < kTileColumns; ++j)
        {
            const Vec factor = hn::Set(kTag, V[j]);
#pragma GCC unroll 8
            for (int v = 0; v < kVectors; ++v) sum[j][v] = hn::MulAdd(u[v], factor, sum[j][v]);
        }
    }
    const int last = rows - (kVectors - 1) * kLanes;
#pragma GCC unroll 8
    for (int j = 0; j < kTileColumns; ++j)
    {
        if (j >= columns) break;
        double* c = C.m_start + j * C.m_stride;
#pragma GCC unroll 8
        for (int v = 0; v + 1 < kVectors; ++v, c += kLanes) subtractLanes(sum[j][v], kLanes, c);
        subtractLanes(sum[j][kVectors - 1], last, c);
    }
}

// C -= U V^T with packed factors, down the columns of C, which suits hardware prefetching.
void subtractPanels(const Panels& U, const Panels& V, const Target& C)
{
    for (int column = 0; column < V.m_rows; column += kTileColumns)
    {
        const int columns = std::min(kTileColumns, V.m_rows - column);
        for (int row = C.m_lowerOnly ? column / kTileRows * kTileRows : 0; row < U.m_rows; row += kTileRows)
        {
            const int rows = std::min(kTileRows, U.m_rows - row);
            const int vectors = (rows + kLanes - 1) / kLanes;
            const Target tile = {C.m_start + row + column * C.m_stride, C.m_stride, false};
            const auto subtract = vectors == 3 ? subtractTile<3> : vectors == 2 ? subtractTile<2> : subtractTile<1>;
            subtract(U.panel(row), V.panel(column), U.m_k, tile, rows, columns);
        }
    }
}

double* aligned(double* p)
{
    return reinterpret_cast<double*>((reinterpret_cast<std::uintptr_t>(p) + 63) / 64 * 64);
}

void subtractProduct(const DenseProduct& p, double* scratch)
{
    const Panels U = packTall({p.m_U, p.m_m, p.m_k, 1, p.m_strideU}, aligned(scratch));
    const Panels V = packWide({p.m_V, p.m_n, p.m_k, 1, p.m_strideV}, U.end());
    subtractPanels(U, V, {p.m_C, p.m_strideC, p.m_lowerOnly});
}

// Sweeps the symmetric n x n matrix T, both halves, on one pivot after another.
int sweepSmall(int n, double* HWY_RESTRICT T, double& pivotValue)
{
    for (int k = 0; k < n; ++k)
    {
        double* pivotColumn = T + k * n;
        const double pivot = pivotValue = pivotColumn[k];
        if (!(pivot > 0 && std::isfinite(pivot))) return k;
        double scaled[kInnerBlock];
        for (int i = 0; i < n; ++i) scaled[i] = pivotColumn[i] / pivot;
        for (int j = 0; j < n; ++j)
        {
            if (j == k) continue;
            for (int i = 0; i < n; ++i) T[i + j * n] -= pivotColumn[i] * scaled[j];
        }
        for (int i = 0; i < n; ++i) T[i + k * n] = T[k + i * n] = scaled[i];
        T[k + k * n] = -1 / pivot;
    }
    return -1;
}

int sweep(const DenseFront& front, int largestBlock, double* scratch, double& pivotValue);

// Computes -A_kk^-1 of the pivots k ... k + n - 1, both halves.
int sweptPivotBlock(const DenseFront& front, int k, int n, double* T, double* scratch, double& pivotValue)
{
    for (int j = 0; j < n; ++j)
        for (int i = j; i < n; ++i)
            T[i + j * n] = T[j + i * n] = front.m_A11[k + i + static_cast<std::size_t>(k + j) * front.m_pivots];
    if (n <= kInnerBlock) return sweepSmall(n, T, pivotValue);
    return sweep({n, 0, T, nullptr, nullptr}, kInnerBlock, scratch, pivotValue);
}

void clear(double* C, int rows, int columns, std::ptrdiff_t stride)
{
    for (int j = 0; j < columns; ++j) std::fill_n(C + j * stride, rows, 0.0);
}

// A block column of the front while A_ik is replaced by A_ik A_kk^-1: packed before and after.
struct SweptRows
{
    Panels m_old, m_new;
};

// For rows i stored below the block k, at X.
SweptRows sweepRows(const View& X, double* store, const Panels& T, double*& scratch)
{
    SweptRows rows;
    rows.m_old = packWide(X, scratch);
    const Panels old = packTall(X, rows.m_old.end());
    clear(store, X.m_rows, X.m_columns, X.m_columnStride);
    subtractPanels(old, T, {store, X.m_columnStride, false});
    rows.m_new = packTall(X, old.m_start);
    scratch = rows.m_new.end();
    return rows;
}

// For rows i before the block k: X stores A_ki.
SweptRows sweepRowsAbove(const View& X, double* store, const Panels& T, double*& scratch)
{
    const View transposed = {X.m_start, X.m_columns, X.m_rows, X.m_columnStride, X.m_rowStride};
    SweptRows rows;
    rows.m_old = packWide(transposed, scratch);
    clear(store, X.m_rows, X.m_columns, X.m_columnStride);
    subtractPanels(T, rows.m_old, {store, X.m_columnStride, false});
    rows.m_new = packTall(transposed, rows.m_old.end());
    scratch = rows.m_new.end();
    return rows;
}

// Sweeps the front on n pivots from k on.
int sweepBlock(const DenseFront& front, int k, int n, double* scratch, double& pivotValue)
{
    const int p = front.m_pivots, r = front.m_rows, end = k + n;
    double* const block = front.m_A11 + k + static_cast<std::size_t>(k) * p;
    double* const T = scratch;
    scratch = aligned(scratch + n * n);
    const int failed = sweptPivotBlock(front, k, n, T, scratch, pivotValue);
    if (failed >= 0) return k + failed;

    const Panels wideT = packWide({T, n, n, 1, n}, scratch);
    const Panels tallT = packTall({T, n, n, 1, n}, wideT.end());
    double* free = tallT.end();
    double *const above = front.m_A11 + k, *const after = block + n;
    double* const below = front.m_A21 + static_cast<std::ptrdiff_t>(k) * r;
    const SweptRows I = sweepRowsAbove({above, n, k, 1, p}, above, tallT, free);
    const SweptRows J = sweepRows({after, p - end, n, 1, p}, after, wideT, free);
    const SweptRows L = sweepRows({below, r, n, 1, r}, below, wideT, free);

    double* const afterColumns = front.m_A11 + static_cast<std::ptrdiff_t>(end) * p;
    subtractPanels(I.m_new, I.m_old, {front.m_A11, p, true});
    subtractPanels(J.m_new, I.m_old, {front.m_A11 + end, p, false});
    subtractPanels(J.m_new, J.m_old, {afterColumns + end, p, true});
    subtractPanels(L.m_new, I.m_old, {front.m_A21, r, false});
    subtractPanels(L.m_new, J.m_old, {front.m_A21 + static_cast<std::ptrdiff_t>(end) * r, r, false});
    subtractPanels(L.m_new, L.m_old, {front.m_A22, r, true});
    for (int j = 0; j < n; ++j) std::copy_n(T + j * n, n, block + static_cast<std::ptrdiff_t>(j) * p);
    return -1;
}

// Sweeps the front on all its pivots in blocks of similar size and fills the upper half of A11.
int sweep(const DenseFront& front, int largestBlock, double* scratch, double& pivotValue)
{
    const int p = front.m_pivots;
    const int blocks = (p + largestBlock - 1) / largestBlock;
    for (int b = 0, k = 0; b < blocks; ++b)
    {
        const int end = static_cast<int>(static_cast<long>(p) * (b + 1) / blocks);
        const int failed = sweepBlock(front, k, end - k, scratch, pivotValue);
        if (failed >= 0) return failed;
        k = end;
    }
    for (int j = 0; j < p; ++j)
        for (int i = j + 1; i < p; ++i)
            front.m_A11[j + static_cast<std::size_t>(i) * p] = front.m_A11[i + static_cast<std::size_t>(j) * p];
    return -1;
}

int eliminatePivots(const DenseFront& front, double* scratch, double& pivotValue)
{
    const int failed = sweep(front, kOuterBlock, aligned(scratch), pivotValue);
    const std::size_t n = static_cast<std::size_t>(front.m_pivots) * front.m_pivots;
    for (std::size_t i = 0; i < n; ++i) front.m_A11[i] = -front.m_A11[i];
    return failed;
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{
namespace
{

HWY_EXPORT(eliminatePivots);
HWY_EXPORT(subtractProduct);

// Scratch of one level of blocks: the swept block and its panels, then twice the rows of each of the three groups.
std::size_t sweepScratch(std::size_t block, std::size_t rows)
{
    return block * (block + 2 * (block + kTallestPanel) + 2 * (rows + 3 * kTallestPanel)) + 2 * kAlignment;
}

}  // namespace

std::size_t eliminationScratch(int maxPivots, int maxRows)
{
    const std::size_t rows = static_cast<std::size_t>(maxPivots) + maxRows;
    return sweepScratch(kOuterBlock, rows) + sweepScratch(kInnerBlock, kOuterBlock);
}

int eliminatePivots(const DenseFront& front, double* scratch, double& pivotValue)
{
    return HWY_DYNAMIC_DISPATCH(eliminatePivots)(front, scratch, pivotValue);
}

std::size_t productScratch(int m, int n, int k)
{
    return (static_cast<std::size_t>(m) + n + 2 * kTallestPanel) * k + kAlignment;
}

void subtractProduct(const DenseProduct& product, double* scratch)
{
    HWY_DYNAMIC_DISPATCH(subtractProduct)(product, scratch);
}

}  // namespace bullet_fem
#endif
