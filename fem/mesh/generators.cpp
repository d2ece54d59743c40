// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/generators.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fem/common/message.h"
#include "fem/mesh/cell_split.h"

namespace bullet_fem
{
namespace
{

constexpr int kMaxCells = 1000;         // maximum along one axis
constexpr double kMaxTets = 5'000'000;  // maximum in one mesh, as in CageSettings
constexpr double kPi = 3.14159265358979323846;
// Scale of the cells in the middle of a ball or disc [-]. Found by search: the minimum volume / longest edge^3 of an
// element is above 0.03 for every cell count up to 40, and smaller for other scales.
constexpr double kBallCoreScale = 0.9;

void checkLength(const char* what, double value)
{
    if (!(value > 0) || !std::isfinite(value))
        reject(what, " is ", value, " m, not in (0, inf); give a positive finite length");
}

void checkCells(const char* what, int cells, int least = 1)
{
    if (cells < least || cells > kMaxCells)
        reject(what, " is ", cells, ", outside [", least, ", ", kMaxCells, "]; choose another cell size");
}

void checkEvenCells(const char* what, int cells)
{
    if (cells < 2 || cells > kMaxCells || cells % 2 != 0)
        reject(what, " is ", cells, ", not an even number in [2, ", kMaxCells, "]; choose another cell size");
}

/// A grid of cells with nodes at the grid points.
struct Grid
{
    std::array<int, 3> m_cells;

    int node(int i, int j, int k) const { return (k * (m_cells[1] + 1) + j) * (m_cells[0] + 1) + i; }

    void checkCount(int tetsPerCell) const
    {
        const double tets = 1.0 * m_cells[0] * m_cells[1] * m_cells[2] * tetsPerCell;
        if (tets > kMaxTets)
            reject(m_cells[0], " x ", m_cells[1], " x ", m_cells[2], " cells make ", tets, " elements, outside [1, ",
                   kMaxTets, "]; use fewer or larger cells");
    }

    /// Calls visit(i, j, k) for i in [0, m_cells[0] + extra) and so on, i fastest: extra = 0 visits cells, 1 nodes.
    template <typename Visit>
    void forEach(int extra, Visit visit) const
    {
        for (int k = 0; k < m_cells[2] + extra; ++k)
            for (int j = 0; j < m_cells[1] + extra; ++j)
                for (int i = 0; i < m_cells[0] + extra; ++i) visit(i, j, k);
    }

    /// Appends the tets of a cell. Bit a of `mirror` is set if the split is reflected along axis a.
    template <std::size_t N>
    void appendCell(const std::array<int, 3>& cell, const std::array<CornerTet, N>& split, int mirror,
                    std::vector<Tet>& tets) const
    {
        const bool odd = (mirror & 1) ^ (mirror >> 1 & 1) ^ (mirror >> 2 & 1);
        for (const CornerTet& corners : split)
        {
            Tet tet;
            for (int a = 0; a < 4; ++a)
            {
                const int c = corners[a] ^ mirror;
                tet[a] = node(cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2 & 1));
            }
            if (odd) std::swap(tet[2], tet[3]);
            tets.push_back(tet);
        }
    }
};

/// Maps the square or cube [-1, 1]^d (the first d coordinates of q) to the unit disc or ball. With rho the maximum
/// |q_a|, the shell rho = 1 maps to the sphere along equal angles, t = tan(pi q / 4 rho), and inner shells blend into a
/// plain cube in the middle: p = rho ((1 - rho) s t + rho t / |t|). Each pyramid between the centre and a face maps
/// smoothly, with a nonsingular Jacobian; a map smooth across pyramids would flatten the cells at the cube's edges.
Vec3 ballFromCube(const Vec3& q)
{
    const double rho = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    if (rho == 0) return {};
    const Vec3 t = {std::tan(kPi / 4 * q.x / rho), std::tan(kPi / 4 * q.y / rho), std::tan(kPi / 4 * q.z / rho)};
    return rho * ((1 - rho) * kBallCoreScale + rho / norm(t)) * t;
}

/// Coordinate of grid line i of n in [-1, 1], exactly antisymmetric about the middle.
double centred(int i, int n)
{
    return (2.0 * i - n) / n;
}

}  // namespace

TetMesh makeBox(const Vec3& size, const std::array<int, 3>& cells, const Vec3& origin, CellSplit split)
{
    const char* sizes[] = {"box size along x", "box size along y", "box size along z"};
    const char* counts[] = {"cell count along x", "cell count along y", "cell count along z"};
    for (int a = 0; a < 3; ++a)
    {
        checkLength(sizes[a], size[a]);
        checkCells(counts[a], cells[a]);
    }
    if (!isFinite(origin))
        reject("box origin is (", origin.x, ", ", origin.y, ", ", origin.z, ") m, not finite; give a finite corner");
    const Grid grid{cells};
    grid.checkCount(split == CellSplit::kuhnSix ? 6 : 5);

    std::vector<Vec3> X;
    grid.forEach(1,
                 [&](int i, int j, int k) {
                     X.push_back(origin + Vec3{size.x * i / cells[0], size.y * j / cells[1], size.z * k / cells[2]});
                 });
    std::vector<Tet> tets;
    grid.forEach(0,
                 [&](int i, int j, int k)
                 {
                     if (split == CellSplit::kuhnSix)
                         grid.appendCell({i, j, k}, kKuhnTets, 0, tets);
                     else
                         grid.appendCell({i, j, k}, kFiveTets[(i + j + k) & 1], 0, tets);
                 });
    return TetMesh(std::move(X), std::move(tets));
}

TetMesh makeBeam(double length, double width, double height, double cellSize, CellSplit split)
{
    checkLength("beam length", length);
    checkLength("beam width", width);
    checkLength("beam height", height);
    checkLength("cell size", cellSize);
    const double longest = std::max({length, width, height});
    if (longest / cellSize > kMaxCells)
        reject("cell size is ", cellSize, " m, outside [", longest / kMaxCells, ", inf) for a beam of ", longest,
               " m; use larger cells");
    const auto count = [&](double extent) { return std::max(1, static_cast<int>(std::lround(extent / cellSize))); };
    return makeBox({length, width, height}, {count(length), count(width), count(height)}, {}, split);
}

// Balls and cylinders use six tets a cell around a diagonal that points away from the centre (the axis): every element
// then lies within one pyramid of ballFromCube, and none has all its nodes on the round surface, where it would be
// flat.

TetMesh makeSphere(double radius, int cells)
{
    return makeSphere(radius, std::array<int, 3>{cells, cells, cells});
}

// With an odd number of cells, the diagonal of a middle cell starts at a node that is not on the surface.
TetMesh makeSphere(double radius, const std::array<int, 3>& cells)
{
    checkLength("sphere radius", radius);
    for (int count : cells) checkCells("cell count of the sphere", count, 2);
    const Grid grid{cells};
    grid.checkCount(6);

    std::vector<Vec3> X;
    grid.forEach(
        1,
        [&](int i, int j, int k) {
            X.push_back(radius * ballFromCube({centred(i, cells[0]), centred(j, cells[1]), centred(k, cells[2])}));
        });
    std::vector<Tet> tets;
    grid.forEach(0,
                 [&](int i, int j, int k)
                 {
                     const int mirror = (2 * i < cells[0]) | (2 * j < cells[1]) << 1 | (2 * k < cells[2]) << 2;
                     grid.appendCell({i, j, k}, kKuhnTets, mirror, tets);
                 });
    return TetMesh(std::move(X), std::move(tets));
}

TetMesh makeCylinder(double radius, double height, int cells, int layers)
{
    checkLength("cylinder radius", radius);
    checkLength("cylinder height", height);
    checkEvenCells("cell count across the cylinder", cells);
    checkCells("layer count of the cylinder", layers);
    const Grid grid{{cells, cells, layers}};
    grid.checkCount(6);

    std::vector<Vec3> X;
    grid.forEach(1,
                 [&](int i, int j, int k)
                 {
                     const Vec3 disc = radius * ballFromCube({centred(i, cells), centred(j, cells), 0});
                     X.push_back({disc.x, disc.y, height / 2 * centred(k, layers)});
                 });
    std::vector<Tet> tets;
    grid.forEach(0,
                 [&](int i, int j, int k)
                 {
                     const int mirror = (2 * i < cells) | (2 * j < cells) << 1;
                     grid.appendCell({i, j, k}, kKuhnTets, mirror, tets);
                 });
    return TetMesh(std::move(X), std::move(tets));
}

}  // namespace bullet_fem
