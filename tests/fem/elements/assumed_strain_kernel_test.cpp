// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The kernels of assumed strains against plain C++ and against the assembled matrix, on every instruction set.
#include "benchmarks/reference/positive_part.h"
#include "fem/common/rotation.h"
#include "fem/scenes/element_case.h"
#include "fem/scenes/lattice_box.h"
#include "fem/scenes/reference_math.h"
#include "fem/scenes/sparse_stiffness.h"

namespace bullet_fem
{
namespace
{

constexpr double kDamping = 0.05;  // of ElementCase::pass() [s]

/// The kernels in plain C++, from the assumed strains and the stresses that they cause.
class AssumedReference
{
public:
    AssumedReference(const RestShape& shape, const std::vector<Vec3>& x)
        : m_shape(shape), m_x(x), m_R(shape.m_elements.size()), m_tension(m_R.size())
    {
    }

    /// `initial`: one stress an element, times V, or none.
    std::vector<Vec3> forces(const std::vector<Vec3>& v, const std::vector<SymmetricTensor>& initial)
    {
        std::vector<Vec3> sum(m_x.size());
        std::vector<SymmetricTensor> strain(m_R.size()), damped(m_R.size());
        const std::vector<Mat3> mean = meanGradients();
        for (std::size_t e = 0; e < m_R.size(); ++e)
        {
            const Mat3 F = gradient(e, m_x);
            m_R[e] = polarRotation(mean[m_shape.m_patches.m_patch[e]], Mat3::identity());
            strain[e] = symmetricPart(transposeTimes(m_R[e], F) - Mat3::identity());
            damped[e] = strain[e] + kDamping * symmetricPart(transposeTimes(m_R[e], gradient(e, v)));
        }
        const std::vector<SymmetricTensor> elastic = stresses(strain), all = stresses(damped);
        const auto given = [&](std::size_t e) { return initial.empty() ? Mat3() : toMatrix(initial[e]); };
        std::vector<Mat3> torque(m_shape.m_patches.count());  // sum of (R^T F) stress
        for (std::size_t e = 0; e < m_R.size(); ++e)
            torque[m_shape.m_patches.m_patch[e]] +=
                transposeTimes(m_R[e], gradient(e, m_x)) * (toMatrix(elastic[e]) + given(e));
        for (std::size_t e = 0; e < m_R.size(); ++e)
        {
            const int p = m_shape.m_patches.m_patch[e];
            const Mat3 S = transposeTimes(m_R[e], mean[p]), stress = toMatrix(elastic[e]) + given(e);
            const Mat3 W = reference::spinBalance(0.5 * (S + transpose(S)), torque[p]);
            const Mat3 P = toMatrix(all[e]) + given(e) + m_shape.shareOfPatch(static_cast<int>(e)) * W;
            m_tension[e] = ElementCase<double>::kTensionFactor * positivePart(stress);
            addCorners(e, -1.0 * (m_R[e] * timesTranspose(P, m_shape.m_elements[e].m_DmInverse)), sum);
        }
        return sum;
    }

    /// After forces().
    std::vector<Vec3> times(const std::vector<Vec3>& p) const
    {
        std::vector<Vec3> sum(m_x.size());
        std::vector<SymmetricTensor> strain(m_R.size());
        for (std::size_t e = 0; e < m_R.size(); ++e) strain[e] = symmetricPart(transposeTimes(m_R[e], gradient(e, p)));
        const std::vector<SymmetricTensor> stress = stresses(strain);
        for (std::size_t e = 0; e < m_R.size(); ++e)
        {
            const Mat3 P =
                ElementCase<double>::kStiffnessFactor * (m_R[e] * toMatrix(stress[e])) + gradient(e, p) * m_tension[e];
            addCorners(e, timesTranspose(P, m_shape.m_elements[e].m_DmInverse), sum);
        }
        return sum;
    }

private:
    // Mean F of every patch.
    std::vector<Mat3> meanGradients() const
    {
        std::vector<Mat3> mean(m_shape.m_patches.count());
        for (std::size_t e = 0; e < m_R.size(); ++e)
            mean[m_shape.m_patches.m_patch[e]] += m_shape.shareOfPatch(static_cast<int>(e)) * gradient(e, m_x);
        return mean;
    }

    Mat3 gradient(std::size_t e, const std::vector<Vec3>& u) const
    {
        const Tet& tet = m_shape.m_mesh.tets()[e];
        const Vec3& u0 = u[tet[0]];
        return Mat3::fromColumns(u[tet[1]] - u0, u[tet[2]] - u0, u[tet[3]] - u0) * m_shape.m_elements[e].m_DmInverse;
    }

    // V times stresses that do the work of Hooke's stress in the assumed strain on the elements' own strains: with the
    // sum S of all stresses of the patch, share S + H (stress - share S).
    std::vector<SymmetricTensor> stresses(const std::vector<SymmetricTensor>& strain) const
    {
        std::vector<SymmetricTensor> result(strain.size());
        const ElementPatches& patches = m_shape.m_patches;
        for (int p = 0; p < patches.count(); ++p)
        {
            const int *element = &patches.m_element[patches.m_start[p]], count = patches.size(p);
            std::vector<double> share;
            std::vector<SymmetricTensor> assumed;
            for (int k = 0; k < count; ++k)
            {
                share.push_back(m_shape.shareOfPatch(element[k]));
                assumed.push_back(strain[element[k]]);
            }
            m_shape.m_assumedStrain.assume(p, count, share.data(), assumed.data());
            SymmetricTensor sum;
            for (int k = 0; k < count; ++k)
            {
                const RestElement& rest = m_shape.m_elements[element[k]];
                const double pressure = rest.m_lambdaVolume * trace(assumed[k]);
                result[element[k]] =
                    2 * rest.m_muVolume * assumed[k] + SymmetricTensor{pressure, pressure, pressure, 0, 0, 0};
                sum += result[element[k]];
            }
            for (int k = 0; k < count; ++k)
            {
                SymmetricTensor& stress = result[element[k]];
                const SymmetricTensor mean = share[k] * sum;
                stress = mean + m_shape.m_assumedStrain.filtered(p, stress + -1.0 * mean);
            }
        }
        return result;
    }

    void addCorners(std::size_t e, const Mat3& f, std::vector<Vec3>& sum) const
    {
        const Tet& tet = m_shape.m_mesh.tets()[e];
        for (int a = 0; a < 3; ++a)
        {
            sum[tet[a + 1]] += f.column(a);
            sum[tet[0]] -= f.column(a);
        }
    }

    const RestShape& m_shape;
    const std::vector<Vec3>& m_x;
    std::vector<Mat3> m_R, m_tension;
};

class AssumedStrainKernels : public OnTarget
{
protected:
    AssumedStrainKernels()
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
        material.m_bending = Bending::accurate;
        return material;
    }

    std::vector<SymmetricTensor> someStress() const
    {
        std::vector<SymmetricTensor> stress;
        for (int e = 0; e < m_mesh.tetCount(); ++e)
        {
            const auto entry = [e](int k) { return 1e-3 * ((7 * e + 3 * k) % 11 - 5); };
            stress.push_back({entry(0), entry(1), entry(2), entry(3), entry(4), entry(5)});
        }
        return stress;
    }

    template <class Real>
    static std::vector<Vec3> forces(ElementCase<Real>& kernels, const std::vector<SymmetricTensor>& initial, int atOnce)
    {
        std::vector<StressBlock<Real>> blocks(kernels.m_warped.size());
        ElementPass<Real> pass = kernels.pass();
        for (std::size_t lane = 0; lane < kernels.m_lanes.m_element.size() && !initial.empty(); ++lane)
        {
            const SymmetricTensor& s = initial[kernels.m_lanes.m_element[lane]];
            const double entries[6] = {s.xx, s.yy, s.zz, s.yz, s.xz, s.xy};
            for (int k = 0; k < 6; ++k) blocks[lane / kLanes].m_entry[k][lane % kLanes] = static_cast<Real>(entries[k]);
        }
        if (!initial.empty()) pass.m_initialStress = blocks.data();
        for (int begin = 0; begin < kernels.blocks().m_end; begin += atOnce)
            runElementPass(pass, {begin, std::min(kernels.blocks().m_end, begin + atOnce)});
        return kernels.cornerSums();
    }

    template <class Real>
    static std::vector<Vec3> times(ElementCase<Real>& kernels, const std::vector<Vec3>& p, int atOnce)
    {
        const std::vector<PaddedVec3> in = padded(p);
        for (int begin = 0; begin < kernels.blocks().m_end; begin += atOnce)
            runElementProduct(kernels.product(in), {begin, std::min(kernels.blocks().m_end, begin + atOnce)});
        return kernels.cornerSums();
    }

    template <class Real>
    void expectReference(double tolerance)
    {
        for (const bool isStressed : {false, true})
        {
            ElementCase<Real> kernels(m_shape, m_x, m_v);
            AssumedReference plain(m_shape, m_x);
            const std::vector<SymmetricTensor> initial = isStressed ? someStress() : std::vector<SymmetricTensor>();
            const std::vector<Vec3> f = plain.forces(m_v, initial), y = plain.times(m_p);
            EXPECT_LE(largestDistance(forces(kernels, initial, kAllAtOnce), f), tolerance * largest(f));
            EXPECT_LE(largestDistance(times(kernels, m_p, kAllAtOnce), y), tolerance * largest(y));
        }
    }

    template <class Real>
    void expectSameInRanges()
    {
        ElementCase<Real> whole(m_shape, m_x, m_v), parts(m_shape, m_x, m_v);
        for (const int atOnce : {1, 3})
        {
            EXPECT_EQ(largestDistance(forces(whole, {}, kAllAtOnce), forces(parts, {}, atOnce)), 0);
            EXPECT_EQ(largestDistance(times(whole, m_p, kAllAtOnce), times(parts, m_p, atOnce)), 0);
        }
    }

    static constexpr int kAllAtOnce = 1 << 20;
    TetMesh m_mesh;
    RestShape m_shape;
    std::vector<Vec3> m_x, m_v, m_p;
};

TEST_P(AssumedStrainKernels, AreThoseOfPlainCode)
{
    expectReference<float>(2e-5);
    expectReference<double>(1e-12);
}

TEST_P(AssumedStrainKernels, HaveTheSameBitsInAnyRanges)
{
    expectSameInRanges<float>();
    expectSameInRanges<double>();
}

// At rest, with identity rotations: the assembled K of the energy.
TEST_P(AssumedStrainKernels, ApplyTheAssembledStiffness)
{
    const std::vector<Vec3>& X = m_mesh.restPositions();
    ElementCase<double> kernels(m_shape, X, std::vector<Vec3>(X.size()));
    EXPECT_LE(largest(kernels.forces()), 1e-9);
    const std::vector<Vec3> y = kernels.times(m_p);
    Eigen::VectorXd p(3 * m_mesh.nodeCount());
    for (int i = 0; i < m_mesh.nodeCount(); ++i)
        for (int c = 0; c < 3; ++c) p[3 * i + c] = m_p[i][c];
    const Eigen::VectorXd Kp = ElementCase<double>::kStiffnessFactor * (sparseStiffness(m_shape) * p);
    for (int i = 0; i < m_mesh.nodeCount(); ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(y[i][c], Kp[3 * i + c], 1e-9 * largest(y));
}

// Q (A p) for a state rotated by Q, and zero forces for rotated rest shapes.
TEST_P(AssumedStrainKernels, TurnWithTheBody)
{
    const Mat3 Q = rotationAbout({2, -1, 3}, 2.2);
    std::vector<Vec3> turned, rates, p;
    for (std::size_t i = 0; i < m_x.size(); ++i)
    {
        turned.push_back(Q * m_x[i]);
        rates.push_back(Q * m_v[i]);
        p.push_back(Q * m_p[i]);
    }
    ElementCase<double> kernels(m_shape, m_x, m_v), other(m_shape, turned, rates);
    std::vector<Vec3> f = kernels.forces(), y = kernels.times(m_p);
    for (Vec3& a : f) a = Q * a;
    for (Vec3& a : y) a = Q * a;
    EXPECT_LE(largestDistance(other.forces(), f), 1e-12 * largest(f));
    EXPECT_LE(largestDistance(other.times(p), y), 1e-12 * largest(y));

    for (std::size_t i = 0; i < m_x.size(); ++i) turned[i] = Q * m_mesh.restPositions()[i] + Vec3{5, -2, 1};
    ElementCase<double> still(m_shape, turned, std::vector<Vec3>(m_x.size()));
    EXPECT_LE(largest(still.forces()), 1e-12 * largest(f));
}

// Elastic forces only; damping by K' has a torque about deformed positions.
TEST_P(AssumedStrainKernels, HaveNoTorqueAndNoSum)
{
    ElementCase<double> kernels(m_shape, m_x, std::vector<Vec3>(m_x.size()));
    for (const bool isStressed : {false, true})
    {
        const std::vector<Vec3> f =
            forces(kernels, isStressed ? someStress() : std::vector<SymmetricTensor>(), kAllAtOnce);
        Vec3 sum, torque;
        for (std::size_t i = 0; i < f.size(); ++i) sum += f[i], torque += cross(m_x[i], f[i]);
        EXPECT_LE(norm(sum), 1e-12 * largest(f));
        EXPECT_LE(norm(torque), 1e-12 * largest(f));
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, AssumedStrainKernels, testing::ValuesIn(availableTargets()), targetName);

}  // namespace
}  // namespace bullet_fem
