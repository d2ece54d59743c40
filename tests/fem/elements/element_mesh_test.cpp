// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The element kernels on meshes, against the double precision loops of warped_elements.h.
#include <cstring>

#include "fem/scenes/element_case.h"
#include "fem/scenes/reference_elements.h"

namespace bullet_fem
{
namespace
{

// A mesh strained by some 20 %, turned by 2 rad and far from the origin, with random velocities.
class ElementMesh : public OnTarget
{
protected:
    static std::vector<TetMesh> meshes()
    {
        const TetMesh box = makeBox({1, 0.6, 0.5}, {4, 2, 2}, {}, CellSplit::kuhnSix);
        return {firstElements(box, 1), firstElements(box, 16), firstElements(box, 17), box, makeSphere(0.5, 2)};
    }

    void deform(const TetMesh& mesh)
    {
        RandomVectors random(9);
        const Mat3 Q = rotationAbout({1, -2, 3}, 2);
        m_x.clear(), m_v.clear();
        for (const Vec3& X : mesh.restPositions())
        {
            m_x.push_back(Q * (1.1 * X + 0.1 * mesh.meanEdgeLength() * random.next()) + Vec3{1000, 2000, -1000});
            m_v.push_back(random.next());
        }
    }

    // Compares the kernels with the double loops; `rounding` is that of Real.
    template <class Real>
    void compare(const RestShape& shape, double rounding)
    {
        ElementCase<Real> kernels(shape, m_x, m_v);
        const std::size_t n = m_x.size(), tets = shape.m_elements.size();
        std::vector<Mat3> R(tets, Mat3::identity());
        std::vector<std::array<double, 6>> tension(tets);
        std::vector<Vec3> force(n), product(n);
        updateElementRotations(shape, m_x, R);
        addElasticForces(shape, m_x, m_v, 0.05, R, force, &tension);
        addStiffnessProduct(shape, R, tension, {kernels.kStiffnessFactor, kernels.kTensionFactor}, m_v, product);

        // A strain of 0.2 is a difference of numbers near 1, and a force accumulates 30 roundings.
        EXPECT_LE(largestDistance(kernels.forces(), force), 100 * rounding * largest(force));
        // The state keeps its quaternions in single precision, 6e-8 an entry.
        for (std::size_t e = 0; e < tets; ++e)
            EXPECT_LE(squaredNorm(kernels.rotation(static_cast<int>(e)) - R[e]), 1e-12) << e;
        EXPECT_LE(largestDistance(kernels.times(m_v), product), 100 * rounding * largest(product));
        compareTension(kernels, R, tension, 100 * rounding);
    }

    template <class Real>
    static void compareTension(const ElementCase<Real>& kernels, const std::vector<Mat3>& R,
                               const std::vector<std::array<double, 6>>& tension, double tolerance)
    {
        double size = 0;
        for (const auto& s : tension) size = std::max({size, s[0], s[1], s[2]});
        EXPECT_GT(size, 0);
        for (std::size_t e = 0; e < R.size(); ++e)
        {
            const int place = kernels.m_lanes.m_lane[e], lane = place % kLanes;
            const auto& t = kernels.m_warped[place / kLanes].m_tension;
            const auto& s = tension[e];
            const Mat3 own = {{{s[0], s[5], s[4]}, {s[5], s[1], s[3]}, {s[4], s[3], s[2]}}};
            const Mat3 expected = kernels.kTensionFactor * (R[e] * timesTranspose(own, R[e]));
            const Mat3 got = {{{t[0][lane], t[5][lane], t[4][lane]},
                               {t[5][lane], t[1][lane], t[3][lane]},
                               {t[4][lane], t[3][lane], t[2][lane]}}};
            // 1e-7 is the error of the double loop's own eigenvectors.
            EXPECT_LE(std::sqrt(squaredNorm(got - expected)), std::max(tolerance, 1e-7) * size) << e;
        }
    }

    std::vector<Vec3> m_x, m_v;
};

TEST_P(ElementMesh, AgreesWithTheDoubleLoopsInBothPrecisions)
{
    for (const TetMesh& mesh : meshes())
        for (const double nu : {0.0, 0.3, 0.45})
        {
            SCOPED_TRACE(std::to_string(mesh.tetCount()) + " elements, nu " + std::to_string(nu));
            const RestShape shape(mesh, elasticMaterial(1e4, nu));
            deform(mesh);
            compare<float>(shape, 6e-8);
            // Positions 2000 m from the origin have roundings of 2e-13 m, a millionth of the edges' float rounding.
            compare<double>(shape, 3e-14);
        }
}

// A stiff body under small loads: strains of 1e-6 would be lost in the rounding of F, 6e-8, or of R.
TEST_P(ElementMesh, SmallStrainsKeepTheirDigits)
{
    const TetMesh mesh = meshes()[3];
    const RestShape shape(mesh, elasticMaterial(1e4, 0.3));
    RandomVectors random(9);
    for (const Vec3& X : mesh.restPositions())
        m_x.push_back(rotationAbout({1, -2, 3}, 2) * (X + 1e-7 * random.next()) + Vec3{1, 2, -1});
    m_v.resize(m_x.size());
    std::vector<Mat3> R(shape.m_elements.size(), Mat3::identity());
    std::vector<Vec3> expected(m_x.size());
    updateElementRotations(shape, m_x, R);
    addElasticForces(shape, m_x, m_v, 0.05, R, expected, nullptr);
    ElementCase<float> kernels(shape, m_x, m_v);
    EXPECT_LE(largestDistance(kernels.forces(), expected), 6e-6 * largest(expected));
}

TEST_P(ElementMesh, MatchesItsScalarReference)
{
    const TetMesh mesh = meshes()[3];
    deform(mesh);
    for (const double nu : {0.3, 0.45})
    {
        const RestShape shape(mesh, elasticMaterial(1e4, nu));
        ElementCase<float> kernels(shape, m_x, m_v), twin(shape, m_x, m_v);
        reference::runElementPass(twin.pass(), twin.blocks());
        const std::vector<Vec3> expected = twin.cornerSums();
        EXPECT_LE(largestDistance(kernels.forces(), expected), 6e-6 * largest(expected));

        const std::vector<PaddedVec3> p = padded(m_v);
        reference::runElementProduct(twin.product(p), twin.blocks());
        const std::vector<Vec3> product = twin.cornerSums();
        EXPECT_LE(largestDistance(kernels.times(m_v), product), 6e-6 * largest(product));
    }
}

TEST_P(ElementMesh, IsSymmetric)
{
    const TetMesh mesh = meshes()[3];
    const RestShape shape(mesh, elasticMaterial(1e4, 0.3));
    deform(mesh);
    ElementCase<float> kernels(shape, m_x, m_v);
    kernels.forces();
    RandomVectors random(3);
    std::vector<Vec3> y;
    for (std::size_t i = 0; i < m_v.size(); ++i) y.push_back(random.next());
    const std::vector<Vec3> Av = kernels.times(m_v), Ay = kernels.times(y);
    double vAy = 0, yAv = 0, vAv = 0, yAy = 0;
    for (std::size_t i = 0; i < y.size(); ++i)
        vAy += dot(m_v[i], Ay[i]), yAv += dot(y[i], Av[i]), vAv += dot(m_v[i], Av[i]), yAy += dot(y[i], Ay[i]);
    EXPECT_LE(std::fabs(vAy - yAv), 1e-6 * std::sqrt(vAv * yAy));
    EXPECT_GT(vAv, 0);
}

// Lanes and summation order are fixed: results do not depend on the division of blocks among threads.
template <class Real>
void expectSameBitsInRanges(const RestShape& shape, const std::vector<Vec3>& x, const std::vector<Vec3>& v)
{
    ElementCase<Real> whole(shape, x, v), parts(shape, x, v);
    const int blocks = whole.m_elements.blockCount(), pieces = whole.m_elements.workUnitCount();
    whole.forces();
    for (const int b : {2, 0, 1}) runElementPass(parts.pass(), {b * pieces / 3, (b + 1) * pieces / 3});
    EXPECT_EQ(0, std::memcmp(whole.m_corners.data(), parts.m_corners.data(), blocks * sizeof(CornerBlock<Real>)));
    EXPECT_EQ(0, std::memcmp(whole.m_warped.data(), parts.m_warped.data(), blocks * sizeof(WarpedBlock<Real>)));
    EXPECT_EQ(0, std::memcmp(whole.m_rotation.data(), parts.m_rotation.data(), blocks * kLanes * sizeof(Quaternion)));

    whole.times(v);
    const std::vector<PaddedVec3> p = padded(v);
    for (const int b : {2, 0, 1}) runElementProduct(parts.product(p), {b * pieces / 3, (b + 1) * pieces / 3});
    EXPECT_EQ(0, std::memcmp(whole.m_corners.data(), parts.m_corners.data(), blocks * sizeof(CornerBlock<Real>)));
}

TEST_P(ElementMesh, HasTheSameBitsHoweverBlocksAreDivided)
{
    const TetMesh mesh = makeBox({1, 0.6, 0.5}, {8, 4, 4}, {}, CellSplit::kuhnSix);
    deform(mesh);
    for (const double nu : {0.3, 0.45})  // without patches, and with them
    {
        const RestShape shape(mesh, elasticMaterial(1e4, nu));
        expectSameBitsInRanges<float>(shape, m_x, m_v);
        expectSameBitsInRanges<double>(shape, m_x, m_v);
    }
}

TEST_P(ElementMesh, PaddingLanesHaveNoForce)
{
    const TetMesh mesh = meshes()[2];
    const RestShape shape(mesh, elasticMaterial(1e4, 0.3));
    deform(mesh);
    ElementCase<float> kernels(shape, m_x, m_v);
    kernels.forces();
    ASSERT_EQ(2, kernels.m_elements.blockCount());
    for (int a = 0; a < 4; ++a)
        for (int lane = 1; lane < kLanes; ++lane)
            for (int c = 0; c < 4; ++c) EXPECT_EQ(0, kernels.m_corners[1].m_vector[a][lane][c]);
}

// Given rotations give the results of computed ones.
TEST_P(ElementMesh, KeepsKnownRotations)
{
    const TetMesh mesh = meshes()[2];
    const RestShape shape(mesh, elasticMaterial(1e4, 0.3));
    deform(mesh);
    ElementCase<float> found(shape, m_x, m_v), known(shape, m_x, m_v);
    found.forces();
    known.m_rotation = found.m_rotation;
    known.m_rotation[0] = {0.6f, 0, 0, 0.8f};  // differs from the polar rotation
    const std::vector<Quaternion> given = known.m_rotation;
    ElementPass<float> pass = known.pass();
    pass.m_isRotated = true;
    runElementPass(pass, known.blocks());
    EXPECT_EQ(0, std::memcmp(given.data(), known.m_rotation.data(), given.size() * sizeof(Quaternion)));
    for (int e = 1; e < mesh.tetCount(); ++e)
        for (int row = 0; row < kWarpedRows; ++row)
        {
            const int at = row * kLanes + e % kLanes;
            const float expected = found.m_warped[e / kLanes].rows()[at];
            ASSERT_NEAR(expected, known.m_warped[e / kLanes].rows()[at], 1e-5 * (1 + std::fabs(expected))) << e;
        }
}

TEST_P(ElementMesh, NoTensionFactorMeansNoTension)
{
    const TetMesh mesh = meshes()[2];
    const RestShape shape(mesh, elasticMaterial(1e4, 0.3));
    deform(mesh);
    ElementCase<float> kernels(shape, m_x, m_v);
    ElementPass<float> pass = kernels.pass();
    pass.m_tensionFactor = 0;
    runElementPass(pass, kernels.blocks());
    for (const WarpedBlock<float>& block : kernels.m_warped)
        for (const auto& entries : block.m_tension)
            for (const float entry : entries) EXPECT_EQ(0, entry);
}

INSTANTIATE_TEST_SUITE_P(Targets, ElementMesh, testing::ValuesIn(availableTargets()), targetName);

}  // namespace
}  // namespace bullet_fem
