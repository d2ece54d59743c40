// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The batched element kernels give each body the bits of the kernels for a single body.
#include "fem/batch/batch_elements.h"

#include <algorithm>
#include <cstring>

#include "fem/batch/batch_arrays.h"
#include "fem/scenes/element_case.h"

namespace bullet_fem
{
namespace
{

bool sameBits(double a, double b)
{
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}

/// Copies of a mesh, strained, rotated and moving differently, as single bodies and in lanes.
class StrainedCopies
{
public:
    StrainedCopies(const TetMesh& mesh, const Material& material)
        : m_model(makeBody(mesh, material).m_model), m_lanes(*m_model)
    {
        for (int b = 0; b < kBatchWidth; ++b)
        {
            const std::vector<Vec3> x = positions(b), v = velocities(b);
            m_alone.emplace_back(m_model->shape(), x, v);
            copyTo(m_lanes.m_x.get(), b, x);
            copyTo(m_lanes.m_v.get(), b, v);
            m_rotation.emplace_back(m_alone[b].m_rotation.size());
            m_warped.emplace_back(m_alone[b].m_warped.size());
        }
    }

    BatchElementPass pass()
    {
        const ElementPass<float> own = m_alone[0].pass();
        BatchElementPass pass = {m_lanes.m_x.get(), m_lanes.m_v.get(), own.m_damping, own.m_tensionFactor, {}, {}, {}};
        for (int b = 0; b < kBatchWidth; ++b)
        {
            pass.m_rotationBefore[b] = m_rotation[b].data();
            if (b == kSpared) continue;
            pass.m_rotation[b] = m_rotation[b].data();
            pass.m_warped[b] = m_warped[b].data();
        }
        return pass;
    }

    void run()
    {
        for (ElementCase<float>& alone : m_alone) runElementPass(alone.pass(), alone.blocks());
        clearSums();
        runElementPass(m_lanes.elements(), pass());
    }

    void multiply()
    {
        for (int b = 0; b < kBatchWidth; ++b) m_product.push_back(m_alone[b].times(velocities(b)));
        clearSums();
        runElementProduct(m_lanes.elements(), ElementCase<float>::kStiffnessFactor, m_lanes.m_v.get());
    }

    void expectTheirForces() const
    {
        for (int b = 0; b < kBatchWidth; ++b) expectSums(b, m_alone[b].cornerSums());
    }
    void expectTheirProducts() const
    {
        for (int b = 0; b < kBatchWidth; ++b) expectSums(b, m_product[b]);
    }

    // The excluded body keeps its rotations.
    void expectTheirRotations() const
    {
        const std::vector<Quaternion> before(m_alone[0].m_rotation.size());
        for (int b = 0; b < kBatchWidth; ++b)
        {
            const std::vector<Quaternion>& expected = b == kSpared ? before : m_alone[b].m_rotation;
            for (const int e : m_alone[b].m_lanes.m_lane)
                EXPECT_EQ(0, std::memcmp(&expected[e], &m_rotation[b][e], sizeof(Quaternion))) << b << ", " << e;
        }
    }

    void expectTheirGradientsAndTensions()
    {
        std::vector<WarpedBlock<float>> before(m_warped[kSpared].size());
        for (int b = 0; b < kBatchWidth; ++b)
            for (const int e : m_alone[b].m_lanes.m_lane)
                for (int row = 0; row < kWarpedRows; ++row)
                {
                    const int at = row * kLanes + e % kLanes;
                    WarpedBlock<float>& expected = b == kSpared ? before[e / kLanes] : m_alone[b].m_warped[e / kLanes];
                    ASSERT_EQ(m_warped[b][e / kLanes].rows()[at], expected.rows()[at]) << b << ", " << e << ", " << row;
                }
    }

private:
    static constexpr int kSpared = 5;

    // Copy 2 is inverted, 3 flat, 4 a point: they converge late, or need the singular value path.
    std::vector<Vec3> positions(int b) const
    {
        RandomVectors random(9 + b);
        const Mat3 Q = rotationAbout({1, -2, 3}, 0.4 * b);
        const Mat3 shape = Mat3::diagonal(b == 4 ? 0.0 : 1.0 + 0.02 * b);
        std::vector<Vec3> x;
        for (Vec3 X : m_model->mesh().restPositions())
        {
            X = shape * X + 0.01 * b * m_model->mesh().meanEdgeLength() * random.next();
            if (b == 2) X.z = -X.z;
            if (b == 3) X.z = 0;
            x.push_back(Q * X + Vec3{10.0 * b, 20, -10});
        }
        return x;
    }

    std::vector<Vec3> velocities(int b) const
    {
        RandomVectors random(70 + b);
        std::vector<Vec3> v;
        for (int i = 0; i < m_model->nodeCount(); ++i) v.push_back(random.next());
        return v;
    }

    static void copyTo(double* lanes, int b, const std::vector<Vec3>& from)
    {
        for (std::size_t i = 0; i < from.size(); ++i)
            for (int c = 0; c < 3; ++c) lanes[(3 * i + c) * kBatchWidth + b] = (&from[i].x)[c];
    }

    void clearSums()
    {
        std::fill_n(m_lanes.m_sums.get(), static_cast<std::size_t>(6 * kBatchWidth) * m_lanes.nodeCount(), 0.0);
    }

    void expectSums(int b, const std::vector<Vec3>& expected) const
    {
        const double* sums = m_lanes.m_sums.get();
        for (std::size_t i = 0; i < expected.size(); ++i)
            for (int c = 0; c < 3; ++c)
            {
                const double even = sums[(6 * i + c) * kBatchWidth + b], odd = sums[(6 * i + 3 + c) * kBatchWidth + b];
                ASSERT_TRUE(sameBits(even + odd, (&expected[i].x)[c])) << b << ", node " << i;
            }
    }

    std::shared_ptr<const BodyModel> m_model;
    BatchArrays m_lanes;
    std::vector<ElementCase<float>> m_alone;
    std::vector<std::vector<Quaternion>> m_rotation;
    std::vector<std::vector<WarpedBlock<float>>> m_warped;
    std::vector<std::vector<Vec3>> m_product;
};

std::vector<Target> vectorTargets()
{
    std::vector<Target> targets = availableTargets();
    const auto isScalar = [](const Target& target) { return target.m_bit == HWY_SCALAR; };
    targets.erase(std::remove_if(targets.begin(), targets.end(), isScalar), targets.end());
    return targets;
}

class ElementsSideBySide : public OnTarget
{
protected:
    // Meshes with fewer elements than a block, with exactly one block, and with more.
    static std::vector<TetMesh> meshes()
    {
        const TetMesh box = makeBox({1, 0.6, 0.5}, {4, 2, 2}, {}, CellSplit::kuhnSix);
        return {firstElements(box, 1), firstElements(box, 16), firstElements(box, 18), box, makeSphere(0.5, 3)};
    }
};

TEST_P(ElementsSideBySide, HaveTheSameBitsAsAlone)
{
    const Material plain = elasticMaterial(1e4, 0.3), inPatches = elasticMaterial(1e4, 0.49);
    Material assumed = elasticMaterial(1e4, 0.45);
    assumed.m_bending = Bending::accurate;
    for (const TetMesh& mesh : meshes())
        for (const Material& material : {plain, inPatches, assumed})
        {
            SCOPED_TRACE(std::to_string(mesh.tetCount()) + " elements, nu " + std::to_string(material.m_poissonRatio));
            StrainedCopies copies(mesh, material);
            copies.run();
            copies.expectTheirForces();
            copies.expectTheirRotations();
            copies.expectTheirGradientsAndTensions();
            copies.multiply();
            copies.expectTheirProducts();
        }
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ElementsSideBySide);  // BULLETFEM_VECTORS=static may have no vectors
INSTANTIATE_TEST_SUITE_P(Targets, ElementsSideBySide, testing::ValuesIn(vectorTargets()), targetName);

}  // namespace
}  // namespace bullet_fem
