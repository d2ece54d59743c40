// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The kernels of smoothed elements against plain C++ and against the assembled matrix, on every instruction set.
#include "fem/elements/smoothed_elements.h"

#include "fem/common/rotation.h"
#include "fem/scenes/element_case.h"
#include "fem/scenes/lattice_box.h"
#include "fem/scenes/reference_elements.h"
#include "fem/scenes/smoothed_stiffness.h"

namespace bullet_fem
{
namespace
{

/// Smoothed kernels with their input and output arrays.
template <class Real>
struct SmoothedCase
{
    SmoothedCase(const RestShape& shape, const std::vector<Vec3>& x, const std::vector<Vec3>& v)
        : m_plain(shape, x, v),
          m_smoothing(shape, m_plain.m_lanes),
          m_warped(m_plain.m_elements.blockCount()),
          m_tension(m_warped.size())
    {
        for (int k = 0; k < 2; ++k)
        {
            m_strain[k].resize(m_warped.size());
            m_mean[k].resize(m_smoothing.domainCount());
        }
    }

    SmoothedStrain<Real> strain(int k) { return {m_strain[k].data(), m_mean[k].data()}; }
    SmoothedPass<Real> pass() { return {m_plain.pass(), &m_smoothing, strain(0), strain(1), m_warped.data()}; }
    SmoothedProduct<Real> product(const std::vector<PaddedVec3>& p)
    {
        return {m_plain.product(p), &m_smoothing, strain(0), m_tension.data(), m_warped.data()};
    }

    /// Ranges of at most `atOnce` chunks, domains and blocks.
    std::vector<Vec3> forces(int atOnce, const std::vector<StressBlock<Real>>* initial = nullptr)
    {
        SmoothedPass<Real> parts = pass();
        if (initial) parts.m_elements.m_initialStress = initial->data();
        inRanges(m_plain.m_elements.workUnitCount(), atOnce, [&](Range r) { findStrains(parts, r); });
        for (int k = 0; k < 2; ++k)
            inRanges(m_smoothing.domainCount(), atOnce, [&](Range r) { averageStrains(m_smoothing, strain(k), r); });
        inRanges(m_plain.m_elements.blockCount(), atOnce, [&](Range r) { findForces(parts, r); });
        return m_plain.cornerSums();
    }

    std::vector<Vec3> times(const std::vector<Vec3>& p, int atOnce)
    {
        const std::vector<PaddedVec3> in = padded(p);
        const SmoothedProduct<Real> parts = product(in);
        inRanges(m_plain.m_elements.workUnitCount(), atOnce, [&](Range r) { findStrains(parts, r); });
        inRanges(m_smoothing.domainCount(), atOnce, [&](Range r) { averageStrains(m_smoothing, strain(0), r); });
        inRanges(m_plain.m_elements.blockCount(), atOnce, [&](Range r) { findForces(parts, r); });
        return m_plain.cornerSums();
    }

    std::vector<Vec3> referenceForces(const std::vector<StressBlock<Real>>* initial = nullptr)
    {
        SmoothedPass<Real> parts = pass();
        if (initial) parts.m_elements.m_initialStress = initial->data();
        reference::findStrains(parts, {0, m_plain.m_elements.workUnitCount()});
        for (int k = 0; k < 2; ++k) reference::averageStrains(m_smoothing, strain(k), {0, m_smoothing.domainCount()});
        reference::findForces(parts, {0, m_plain.m_elements.blockCount()});
        return m_plain.cornerSums();
    }

    std::vector<Vec3> referenceTimes(const std::vector<Vec3>& p)
    {
        const std::vector<PaddedVec3> in = padded(p);
        const SmoothedProduct<Real> parts = product(in);
        reference::findStrains(parts, {0, m_plain.m_elements.workUnitCount()});
        reference::averageStrains(m_smoothing, strain(0), {0, m_smoothing.domainCount()});
        reference::findForces(parts, {0, m_plain.m_elements.blockCount()});
        return m_plain.cornerSums();
    }

    template <class Run>
    static void inRanges(int size, int atOnce, const Run& run)
    {
        for (int begin = 0; begin < size; begin += atOnce) run(Range{begin, std::min(size, begin + atOnce)});
    }

    ElementCase<Real> m_plain;
    EdgeSmoothing<Real> m_smoothing;
    std::vector<SmoothedBlock<Real>> m_warped;
    std::vector<TensionBlock<Real>> m_tension;
    std::vector<StrainQuads<Real>> m_strain[2];
    std::vector<DomainStrain<Real>> m_mean[2];
};

constexpr int kAllAtOnce = 1 << 20;

class SmoothedElements : public OnTarget
{
protected:
    SmoothedElements()
        : m_mesh(shuffledMesh(makeBox({1, .8, .6}, {5, 4, 3}, {}, CellSplit::kuhnSix), .1, 1)), m_shape(m_mesh, soft())
    {
        RandomVectors random(3);
        for (const Vec3& X : m_mesh.restPositions())
        {
            m_x.push_back(rotationAbout({1, 2, -1}, .8) *
                          (X + Vec3{.3 * X.y, -.2 * X.z * X.x, 0} + .01 * random.next()));
            m_v.push_back(random.next());
            m_p.push_back(random.next());
        }
    }

    static Material soft()
    {
        Material material = elasticMaterial(1e4, .45);
        material.m_accurateBending = true;
        return material;
    }

    template <class Real>
    std::vector<StressBlock<Real>> someStress(const SmoothedCase<Real>& kernels) const
    {
        std::vector<StressBlock<Real>> stress(kernels.m_warped.size());
        for (std::size_t lane = 0; lane < kernels.m_plain.m_lanes.m_element.size(); ++lane)
            for (int k = 0; k < 6; ++k)
                stress[lane / kLanes].m_entry[k][lane % kLanes] =
                    static_cast<Real>(1e-3 * ((kernels.m_plain.m_lanes.m_element[lane] * 7 + 3 * k) % 11 - 5));
        return stress;
    }

    template <class Real>
    void expectReference(double tolerance)
    {
        for (const bool isStressed : {false, true})
        {
            SmoothedCase<Real> kernels(m_shape, m_x, m_v), plain(m_shape, m_x, m_v);
            const std::vector<StressBlock<Real>> stress = someStress(kernels);
            const std::vector<StressBlock<Real>>* initial = isStressed ? &stress : nullptr;
            const std::vector<Vec3> f = plain.referenceForces(initial), y = plain.referenceTimes(m_p);
            EXPECT_LE(largestDistance(kernels.forces(kAllAtOnce, initial), f), tolerance * largest(f));
            EXPECT_LE(largestDistance(kernels.times(m_p, kAllAtOnce), y), tolerance * largest(y));
        }
    }

    template <class Real>
    void expectSameInRanges()
    {
        SmoothedCase<Real> whole(m_shape, m_x, m_v), parts(m_shape, m_x, m_v);
        for (const int atOnce : {1, 3})
        {
            EXPECT_EQ(largestDistance(whole.forces(kAllAtOnce), parts.forces(atOnce)), 0);
            EXPECT_EQ(largestDistance(whole.times(m_p, kAllAtOnce), parts.times(m_p, atOnce)), 0);
        }
    }

    TetMesh m_mesh;
    RestShape m_shape;
    std::vector<Vec3> m_x, m_v, m_p;
};

TEST_P(SmoothedElements, AreThoseOfPlainCode)
{
    expectReference<float>(2e-5);
    expectReference<double>(1e-12);
}

TEST_P(SmoothedElements, HaveTheSameBitsInAnyRanges)
{
    expectSameInRanges<float>();
    expectSameInRanges<double>();
}

// At rest, with identity rotations: the assembled K of the energy.
TEST_P(SmoothedElements, ApplyTheAssembledStiffness)
{
    const std::vector<Vec3>& X = m_mesh.restPositions();
    SmoothedCase<double> kernels(m_shape, X, std::vector<Vec3>(X.size()));
    EXPECT_LE(largest(kernels.forces(kAllAtOnce)), 1e-9);
    const std::vector<Vec3> y = kernels.times(m_p, kAllAtOnce);
    Eigen::VectorXd p(3 * m_mesh.nodeCount());
    for (int i = 0; i < m_mesh.nodeCount(); ++i)
        for (int c = 0; c < 3; ++c) p[3 * i + c] = m_p[i][c];
    const Eigen::VectorXd Kp = ElementCase<double>::kStiffnessFactor * (smoothedStiffness(m_shape) * p);
    for (int i = 0; i < m_mesh.nodeCount(); ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(y[i][c], Kp[3 * i + c], 1e-9 * largest(y));
}

// Q (A p) for a state rotated by Q, and zero forces for rotated rest shapes.
TEST_P(SmoothedElements, TurnWithTheBody)
{
    const Mat3 Q = rotationAbout({2, -1, 3}, 2.2);
    std::vector<Vec3> turned, rates, p;
    for (std::size_t i = 0; i < m_x.size(); ++i)
    {
        turned.push_back(Q * m_x[i]);
        rates.push_back(Q * m_v[i]);
        p.push_back(Q * m_p[i]);
    }
    SmoothedCase<double> kernels(m_shape, m_x, m_v), other(m_shape, turned, rates);
    std::vector<Vec3> f = kernels.forces(kAllAtOnce), y = kernels.times(m_p, kAllAtOnce);
    for (Vec3& a : f) a = Q * a;
    for (Vec3& a : y) a = Q * a;
    EXPECT_LE(largestDistance(other.forces(kAllAtOnce), f), 1e-12 * largest(f));
    EXPECT_LE(largestDistance(other.times(p, kAllAtOnce), y), 1e-12 * largest(y));

    for (std::size_t i = 0; i < m_x.size(); ++i) turned[i] = Q * m_mesh.restPositions()[i] + Vec3{5, -2, 1};
    SmoothedCase<double> still(m_shape, turned, std::vector<Vec3>(m_x.size()));
    EXPECT_LE(largest(still.forces(kAllAtOnce)), 1e-12 * largest(f));
}

// Elastic forces only; damping by K' has a torque about deformed positions.
TEST_P(SmoothedElements, HaveNoTorqueAndNoSum)
{
    SmoothedCase<double> kernels(m_shape, m_x, std::vector<Vec3>(m_x.size()));
    const std::vector<StressBlock<double>> stress = someStress(kernels);
    for (const auto* initial : {static_cast<const std::vector<StressBlock<double>>*>(nullptr), &stress})
    {
        const std::vector<Vec3> f = kernels.forces(kAllAtOnce, initial);
        Vec3 sum, torque;
        for (std::size_t i = 0; i < f.size(); ++i) sum += f[i], torque += cross(m_x[i], f[i]);
        EXPECT_LE(norm(sum), 1e-12 * largest(f));
        EXPECT_LE(norm(torque), 1e-12 * largest(f));
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, SmoothedElements, testing::ValuesIn(availableTargets()), targetName);

}  // namespace
}  // namespace bullet_fem
