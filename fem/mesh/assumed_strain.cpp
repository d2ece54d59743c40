// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/assumed_strain.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace bullet_fem
{
namespace
{

constexpr int kOctahedronElements = 4;
constexpr int kRow[6] = {0, 1, 2, 1, 0, 0}, kColumn[6] = {0, 1, 2, 2, 2, 1};  // of xx, yy, zz, yz, xz, xy

std::array<double, 6> componentsOf(const SymmetricTensor& a)
{
    return {a.xx, a.yy, a.zz, a.yz, a.xz, a.xy};
}

// H of a patch with principal axes in the columns of m_axes and extents along them.
struct PatchFilter
{
    Mat3 m_axes;
    double m_extent[3];
    double m_scale;  // sqrt(s)

    Mat3 operator()(const Mat3& a) const
    {
        Mat3 inAxes = transposeTimes(m_axes, (a - Mat3::diagonal(trace(a) / 3)) * m_axes);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (i != j) inAxes(i, j) *= std::min(m_extent[i], m_extent[j]) / std::max(m_extent[i], m_extent[j]);
        return m_scale * (m_axes * timesTranspose(inAxes, m_axes));
    }
};

// Principal axes and extents of the second moments of a patch's volume.
PatchFilter filterOf(const TetMesh& mesh, const int* elements, int count, const std::vector<double>& volume)
{
    const std::vector<Vec3>& X = mesh.restPositions();
    double sum = 0;
    Vec3 middle;
    for (int k = 0; k < count; ++k)
    {
        sum += volume[elements[k]];
        for (const int node : mesh.tets()[elements[k]]) middle += volume[elements[k]] / 4 * X[node];
    }
    middle = 1 / sum * middle;
    Mat3 moments;
    for (int k = 0; k < count; ++k)
    {
        Vec3 corners;
        for (const int node : mesh.tets()[elements[k]])
        {
            const Vec3 r = X[node] - middle;
            moments += volume[elements[k]] / (20 * sum) * outer(r, r);
            corners += r;
        }
        moments += volume[elements[k]] / (20 * sum) * outer(corners, corners);
    }
    Eigen::Matrix3d M;
    for (int k = 0; k < 9; ++k) M(k / 3, k % 3) = moments(k / 3, k % 3);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(M);
    PatchFilter filter = {};
    for (int k = 0; k < 9; ++k) filter.m_axes(k / 3, k % 3) = eigen.eigenvectors()(k / 3, k % 3);
    for (int i = 0; i < 3; ++i) filter.m_extent[i] = std::sqrt(eigen.eigenvalues()[i]);
    return filter;
}

// The upper triangle of a symmetric map of strains with doubled shears to tensor components.
template <class Map>
std::array<double, AssumedStrain::kEntries> matrixOf(const Map& map)
{
    std::array<std::array<double, 6>, 6> image;  // of strains with one component 1
    for (int k = 0; k < 6; ++k)
    {
        Mat3 unit;
        unit(kRow[k], kColumn[k]) += 0.5;
        unit(kColumn[k], kRow[k]) += 0.5;
        image[k] = componentsOf(map(symmetricPart(unit)));
    }
    std::array<double, AssumedStrain::kEntries> entries;
    int next = 0;
    for (int row = 0; row < 6; ++row)
        for (int column = row; column < 6; ++column) entries[next++] = image[column][row];
    return entries;
}

}  // namespace

AssumedStrain::AssumedStrain(const TetMesh& mesh, const ElementMaterials& materials, const ElementPatches& patches,
                             const std::vector<double>& volume)
    : m_filter(patches.count())
{
    std::vector<char> isInner(mesh.nodeCount(), 1);
    for (const int node : mesh.surfaceNodes()) isInner[node] = 0;
    for (int p = 0; p < patches.count(); ++p)
    {
        const int* elements = &patches.m_element[patches.m_start[p]];
        const int count = patches.size(p);
        PatchFilter filter = {Mat3::identity(), {1, 1, 1}, 1};
        if (materials.of(elements[0]).m_bending == Bending::accurate)
        {
            filter = filterOf(mesh, elements, count, volume);
            const bool hasInner = std::any_of(elements, elements + count,
                                              [&](int e)
                                              {
                                                  const Tet& tet = mesh.tets()[e];
                                                  return std::any_of(tet.begin(), tet.end(),
                                                                     [&](int node) { return isInner[node] != 0; });
                                              });
            const double thin = kThinShare * (1 + materials.of(elements[0]).m_poissonRatio);
            filter.m_scale = std::sqrt(!hasInner ? thin : count <= kOctahedronElements ? kOctahedronShare : kShare);
        }
        m_filter[p] = matrixOf([&](const SymmetricTensor& a) { return symmetricPart(filter(toMatrix(a))); });
    }
}

std::array<double, AssumedStrain::kEntries> AssumedStrain::square(int patch) const
{
    return matrixOf([&](const SymmetricTensor& a) { return filtered(patch, filtered(patch, a)); });
}

SymmetricTensor AssumedStrain::filtered(int patch, const SymmetricTensor& a) const
{
    std::array<double, 6> in = componentsOf(a), out = {};
    for (int k = 3; k < 6; ++k) in[k] *= 2;
    int entry = 0;
    for (int row = 0; row < 6; ++row)
        for (int column = row; column < 6; ++column, ++entry)
        {
            out[row] += m_filter[patch][entry] * in[column];
            if (column > row) out[column] += m_filter[patch][entry] * in[row];
        }
    return {out[0], out[1], out[2], out[5], out[3], out[4]};
}

void AssumedStrain::assume(int patch, int count, const double* share, SymmetricTensor* strain) const
{
    SymmetricTensor mean;
    for (int k = 0; k < count; ++k) mean += share[k] * strain[k];
    for (int k = 0; k < count; ++k) strain[k] = mean + filtered(patch, strain[k] + -1.0 * mean);
}

}  // namespace bullet_fem
