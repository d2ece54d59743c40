// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "fem/common/vector_targets.h"

#include <hwy/highway.h>

#include "benchmarks/reference/warped_elements.h"
#include "fem/elements/element_product.h"
#include "fem/elements/node_sums.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{

/// An instruction set that limits the dispatch: it and lesser ones may be used.
struct Target
{
    int64_t m_bit;
};

inline void PrintTo(const Target& target, std::ostream* out)
{
    *out << hwy::TargetName(target.m_bit);
}

/// The instruction sets of this processor and build.
inline std::vector<Target> availableTargets()
{
    std::vector<Target> result;
    for (int64_t rest = hwy::SupportedTargets() & HWY_TARGETS; rest != 0; rest &= rest - 1)
        result.push_back({rest & -rest});
    return result;
}

inline std::string targetName(const testing::TestParamInfo<Target>& info)
{
    return hwy::TargetName(info.param.m_bit);
}

/// A test that runs on every available target.
class OnTarget : public testing::TestWithParam<Target>
{
protected:
    OnTarget() { hwy::SetSupportedTargetsForTest(hwy::SupportedTargets() & ~(GetParam().m_bit - 1)); }
    ~OnTarget() override { hwy::SetSupportedTargetsForTest(0); }
};

inline std::vector<PaddedVec3> padded(const std::vector<Vec3>& u)
{
    std::vector<PaddedVec3> result;
    for (const Vec3& a : u) result.push_back({a.x, a.y, a.z, 0});
    return result;
}

inline double largest(const std::vector<Vec3>& u)
{
    double result = 0;
    for (const Vec3& a : u) result = std::max(result, norm(a));
    return result;
}

/// The first elements of a mesh, with the nodes that they use.
inline TetMesh firstElements(const TetMesh& mesh, int count)
{
    std::vector<int> place(mesh.nodeCount(), -1);
    std::vector<Vec3> X;
    std::vector<Tet> tets(mesh.tets().begin(), mesh.tets().begin() + count);
    for (Tet& tet : tets)
        for (int& node : tet)
        {
            if (place[node] < 0)
            {
                place[node] = static_cast<int>(X.size());
                X.push_back(mesh.restPositions()[node]);
            }
            node = place[node];
        }
    return TetMesh(X, tets);
}

/// Element kernels with their input and output arrays. Rotations start from the identity.
template <class Real>
struct ElementCase
{
    ElementCase(const RestShape& shape, const std::vector<Vec3>& x, const std::vector<Vec3>& v)
        : m_shape(shape),
          m_lanes(shape),
          m_elements(shape),
          m_nodes(shape),
          m_x(padded(x)),
          m_v(padded(v)),
          m_rotation(m_elements.blockCount() * kLanes),
          m_corners(m_elements.blockCount()),
          m_warped(m_elements.blockCount())
    {
    }

    ElementPass<Real> pass()
    {
        return {&m_elements,    m_x.data(),        m_v.data(),       0.05,
                kTensionFactor, m_rotation.data(), m_corners.data(), m_warped.data()};
    }

    ElementProduct<Real> product(const std::vector<PaddedVec3>& p)
    {
        return {&m_elements, m_warped.data(), kStiffnessFactor, p.data(), m_corners.data()};
    }

    Range blocks() const { return {0, m_elements.workUnitCount()}; }

    std::vector<Vec3> cornerSums() const
    {
        std::vector<Vec3> out(m_nodes.nodeCount());
        sumCorners(NodeSums<Real>{&m_nodes, m_corners.data(), nullptr, nullptr, out.data()}, {0, m_nodes.nodeCount()});
        return out;
    }

    std::vector<Vec3> forces()
    {
        runElementPass(pass(), blocks());
        return cornerSums();
    }

    /// A p without mass; forces() must have been called.
    std::vector<Vec3> times(const std::vector<Vec3>& p)
    {
        const std::vector<PaddedVec3> in = padded(p);
        runElementProduct(product(in), blocks());
        return cornerSums();
    }

    Mat3 rotation(int e) const { return toMatrix(m_rotation[m_lanes.m_lane[e]]); }

    static constexpr double kStiffnessFactor = 0.7, kTensionFactor = 0.3;

    const RestShape& m_shape;
    ElementLanes m_lanes;
    ElementBlocks<Real> m_elements;
    NodeCorners m_nodes;
    std::vector<PaddedVec3> m_x, m_v;
    std::vector<Quaternion> m_rotation;
    std::vector<CornerBlock<Real>> m_corners;
    std::vector<WarpedBlock<Real>> m_warped;
};

}  // namespace bullet_fem
