// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Nodal sums and nodal rotations from those of the adjacent elements.
#include <algorithm>
#include <cstring>

#include "fem/common/rotation.h"
#include "fem/elements/node_rotations.h"
#include "fem/scenes/element_case.h"
#include "fem/scenes/reference_elements.h"

namespace bullet_fem
{
namespace
{

Mat3 matrix(const NodeRotation& R)
{
    Mat3 result;
    for (int k = 0; k < 9; ++k) result(k / 3, k % 3) = R.m[k];
    return result;
}

class ElementNodes : public OnTarget
{
protected:
    // Nodal averages of the element rotations R_e.
    std::vector<Mat3> averages() const
    {
        std::vector<NodeRotation> out(m_mesh.nodeCount());
        averageRotations({&m_nodes, m_rotation.data(), out.data()}, {0, m_mesh.nodeCount()});
        std::vector<Mat3> result;
        for (const NodeRotation& R : out) result.push_back(matrix(R));
        return result;
    }

    // polar(sum of V_e R_e).
    std::vector<Mat3> polarRotations() const
    {
        std::vector<Mat3> sum(m_mesh.nodeCount());
        for (int e = 0; e < m_mesh.tetCount(); ++e)
            for (int node : m_mesh.tets()[e]) sum[node] += m_mesh.tetVolume(e) * toMatrix(m_rotation[e]);
        for (Mat3& R : sum) R = polarRotation(R, Mat3::identity());
        return sum;
    }

    // Random rotations by up to about `spread` [rad] from Q, with random signs of their quaternions.
    void spreadRotations(const Mat3& Q, double spread)
    {
        RandomVectors random(6);
        for (Quaternion& q : m_rotation)
        {
            const Vec3 w = spread * random.next();
            q = rounded(toQuaternion(rotationAbout(w + Vec3{1e-9, 0, 0}, norm(w)) * Q));
            const float sign = random.next().x > 0 ? 1.0f : -1.0f;
            q = {sign * q.x, sign * q.y, sign * q.z, sign * q.w};
        }
    }

    static double largestError(const std::vector<Mat3>& a, const std::vector<Mat3>& b)
    {
        double result = 0;
        for (std::size_t i = 0; i < a.size(); ++i) result = std::max(result, std::sqrt(squaredNorm(a[i] - b[i])));
        return result;
    }

    const TetMesh m_mesh = makeBox({1, 0.6, 0.5}, {4, 3, 3});  // nodes of 1, 4, 8 ... elements
    const RestShape m_shape{m_mesh, elasticMaterial(1e4, 0.3)};
    const NodeCorners m_nodes{m_shape};
    std::vector<Quaternion> m_rotation = std::vector<Quaternion>(blockCount(m_mesh.tetCount()) * kLanes);
};

TEST_P(ElementNodes, HaveTheRotationOfARigidMotion)
{
    for (const double angle : {0.0, 1.0, 3.14159265358979, 5.0})
    {
        const Mat3 Q = rotationAbout({1, -2, 3}, angle);
        spreadRotations(Q, 0);
        EXPECT_LE(largestError(averages(), std::vector<Mat3>(m_mesh.nodeCount(), Q)), 1e-6) << angle;
        const Mat3 sum = sumRotations(m_nodes, m_rotation.data(), {0, blockCount(m_mesh.tetCount())});
        EXPECT_LE(std::sqrt(squaredNorm(polarRotation(sum, Mat3::identity()) - Q)), 2e-7) << angle;
    }
}

// The two means differ by terms of the third order in the spread.
TEST_P(ElementNodes, AverageNearRotationsCloseToThePolarOnes)
{
    for (const double spread : {0.02, 0.2, 0.5})
    {
        spreadRotations(rotationAbout({1, -2, 3}, 3), spread);
        EXPECT_LE(largestError(averages(), polarRotations()), 1e-6 + 0.3 * spread * spread * spread) << spread;
    }
}

// A third of the elements is nearly half a turn away from the others: |sum| is about sqrt(1/3), and the mean quaternion
// is invalid. If every third element has a fifth of the volume, |sum| is below sqrt(0.44) and R_i is exactly the polar
// rotation.
TEST_P(ElementNodes, AverageFarRotationsToThePolarOnes)
{
    const Mat3 turns[3] = {Mat3::identity(), rotationAbout({1, 0, 0.01}, 3.12), rotationAbout({0.02, 1, 0}, 3.1)};
    for (std::size_t e = 0; e < m_rotation.size(); ++e) m_rotation[e] = rounded(toQuaternion(turns[e % 3]));
    const std::vector<Mat3> R = averages(), expected = polarRotations();
    int far = 0;
    for (int i = 0; i < m_mesh.nodeCount(); ++i)
    {
        double part[3] = {0, 0, 0};
        Mat3 sum;
        for (int k = m_nodes.m_start[i]; k < m_nodes.m_start[i + 1]; ++k)
        {
            const int e = NodeCorners::element(m_nodes.m_corner[k]);
            part[e % 3] += m_nodes.m_volume[e];
            sum += m_nodes.m_volume[e] * toMatrix(m_rotation[e]);
        }
        const double volume = part[0] + part[1] + part[2];
        const bool everyThird = std::min({part[0], part[1], part[2]}) > 0.2 * volume;
        const double missing = trace(transposeTimes(expected[i], sum)) - trace(transposeTimes(R[i], sum));
        EXPECT_LE(everyThird ? missing : 0, 1e-6 * volume) << i;
        EXPECT_LE(std::sqrt(squaredNorm(transposeTimes(R[i], R[i]) - Mat3::identity())), 1e-6) << i;
        far += everyThird;
    }
    EXPECT_GT(far, 3);
}

TEST_P(ElementNodes, RotationsMatchTheirScalarReferences)
{
    for (const double spread : {0.02, 0.5, 3.0})
    {
        spreadRotations(rotationAbout({1, -2, 3}, 3), spread);
        std::vector<NodeRotation> twin(m_mesh.nodeCount());
        reference::averageRotations({&m_nodes, m_rotation.data(), twin.data()}, {0, m_mesh.nodeCount()});
        std::vector<Mat3> expected;
        for (const NodeRotation& R : twin) expected.push_back(matrix(R));
        // 0.5 % of the volume may be assigned the wrong quaternion sign if it differs by less than the spread.
        EXPECT_LE(largestError(averages(), expected), 1e-6 + 0.01 * std::min(spread, 0.4)) << spread;
        const Range blocks = {0, blockCount(m_mesh.tetCount())};
        const Mat3 sum = reference::sumRotations(m_nodes, m_rotation.data(), blocks);
        EXPECT_LE(squaredNorm(sumRotations(m_nodes, m_rotation.data(), blocks) - sum), 1e-12 * m_mesh.volume());
    }
}

TEST_P(ElementNodes, SumsMatchTheirScalarReference)
{
    RandomVectors random(7);
    std::vector<CornerBlock<float>> corners(blockCount(m_mesh.tetCount()));
    for (auto& block : corners)
        for (auto& corner : block.m_vector)
            for (auto& v : corner) v[0] = static_cast<float>(random.next().x), v[1] = 2, v[2] = v[0] * v[0], v[3] = 0;
    std::vector<Vec3> p, given;
    std::vector<double> scale;
    for (int i = 0; i < m_mesh.nodeCount(); ++i)
        p.push_back(random.next()), given.push_back(random.next()), scale.push_back(1 + 0.1 * i);
    const std::vector<PaddedVec3> paddedP = padded(p);
    for (const double* factors : {static_cast<const double*>(scale.data()), static_cast<const double*>(nullptr)})
    {
        std::vector<Vec3> out = given, expected = given, parts = given;
        const int n = m_mesh.nodeCount();
        sumCorners(NodeSums<float>{&m_nodes, corners.data(), factors, paddedP.data(), out.data()}, {0, n});
        reference::sumCorners(NodeSums<float>{&m_nodes, corners.data(), factors, paddedP.data(), expected.data()},
                              {0, n});
        EXPECT_LE(largestDistance(out, expected), 1e-13);
        for (const Range range : {Range{n / 2, n}, Range{0, n / 2}})
            sumCorners(NodeSums<float>{&m_nodes, corners.data(), factors, paddedP.data(), parts.data()}, range);
        EXPECT_EQ(0, std::memcmp(out.data(), parts.data(), n * sizeof(Vec3)));
    }
}

TEST_P(ElementNodes, KnowTheirCornersInAscendingOrder)
{
    int seen = 0;
    for (int i = 0; i < m_mesh.nodeCount(); ++i)
        for (int k = m_nodes.m_start[i]; k < m_nodes.m_start[i + 1]; ++k, ++seen)
        {
            const int corner = m_nodes.m_corner[k], e = NodeCorners::element(corner);
            const int a = corner / kLanes % 4;
            EXPECT_EQ(i, m_mesh.tets()[e][a]);
            EXPECT_EQ(corner, NodeCorners::corner(e, a));
            EXPECT_LT(k > m_nodes.m_start[i] ? NodeCorners::element(m_nodes.m_corner[k - 1]) : -1, e);
        }
    EXPECT_EQ(4 * m_mesh.tetCount(), seen);
}

TEST(ElementQuaternion, GoesToAMatrixAndBack)
{
    RandomVectors random(8);
    for (int k = 0; k < 200; ++k)
    {
        const Mat3 R = rotationAbout(random.next(), 4 * random.next().x);
        EXPECT_LE(squaredNorm(toMatrix(toQuaternion(R)) - R), 1e-29) << k;
        EXPECT_LE(squaredNorm(toMatrix(rounded(toQuaternion(R))) - R), 1e-13) << k;
    }
    EXPECT_EQ(1, toQuaternion(Mat3::identity()).w);
}

INSTANTIATE_TEST_SUITE_P(Targets, ElementNodes, testing::ValuesIn(availableTargets()), targetName);

}  // namespace
}  // namespace bullet_fem
