// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/block_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "fem/scenes/dense_system.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

class RestStiffness : public testing::TestWithParam<double>  // nu
{
protected:
    const Material m_material = elasticMaterial(1e6, GetParam());
    const RestShape m_shape{makeBox({1, 0.5, 0.7}, {3, 2, 2}), m_material};
    const Eigen::MatrixXd m_K = dense(assembleRestStiffness(m_shape));
};

TEST_P(RestStiffness, ElementBlocksAreThoseOfTheTextbook)
{
    RandomVectors random(3);
    for (int k = 0; k < 50; ++k)
    {
        std::vector<Vec3> X = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (Vec3& x : X) x += 0.2 * random.next();
        const RestShape shape(TetMesh(X, {{0, 1, 2, 3}}), m_material);
        const Eigen::MatrixXd expected = textbookElementStiffness({X[0], X[1], X[2], X[3]}, m_material);
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
                EXPECT_LE((dense(elementStiffnessBlock(shape.m_elements[0], a, b)) - expected.block<3, 3>(3 * a, 3 * b))
                              .norm(),
                          1e-13 * expected.norm())
                    << a << b;
    }
}

TEST_P(RestStiffness, IsTheSumOfItsElements)
{
    const std::vector<Mat3> R(m_shape.m_elements.size(), Mat3::identity());
    const Eigen::MatrixXd expected = denseStiffness(m_shape.m_mesh, m_material, R);
    EXPECT_LE((m_K - expected).norm(), 1e-13 * expected.norm());
}

TEST_P(RestStiffness, IsSymmetricAndHasTheSixRigidModesAlone)
{
    EXPECT_LE((m_K - m_K.transpose()).norm(), 1e-15 * m_K.norm());
    for (int mode = 0; mode < 6; ++mode)
    {
        Vec3 axis;
        axis[mode % 3] = 1;
        std::vector<Vec3> u;
        for (const Vec3& X : m_shape.m_mesh.restPositions()) u.push_back(mode < 3 ? axis : cross(axis, X));
        EXPECT_LE((m_K * flat(u)).norm(), 1e-13 * m_K.norm() * flat(u).norm()) << mode;
    }
    const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m_K).eigenvalues();
    EXPECT_GE(eigenvalues(0), -1e-12 * m_K.norm());
    EXPECT_GT(eigenvalues(6), 1e-4 * m_K.norm());
}

INSTANTIATE_TEST_SUITE_P(Poisson, RestStiffness, testing::Values(0, 0.3, 0.49),
                         [](const auto& suite) { return "Nu" + std::to_string(std::lround(100 * suite.param)); });

// The unit tetrahedron, V = 1/6, g_1 = (1, 0, 0): K_11 = V diag(lambda + 2 mu, mu, mu), K_12 = V (lambda e1 e2^T + mu
// e2 e1^T).
TEST(ElementStiffness, UnitTetrahedronMatchesHandValues)
{
    const Material material = elasticMaterial(260, 0.3);  // lambda 150, mu 100
    const RestShape shape(TetMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}), material);
    const Mat3 K11 = elementStiffnessBlock(shape.m_elements[0], 1, 1);
    EXPECT_DOUBLE_EQ(K11(0, 0), 350. / 6);
    EXPECT_DOUBLE_EQ(K11(1, 1), 100. / 6);
    EXPECT_DOUBLE_EQ(K11(2, 2), 100. / 6);
    EXPECT_DOUBLE_EQ(K11(0, 1), 0);
    const Mat3 K12 = elementStiffnessBlock(shape.m_elements[0], 1, 2);
    EXPECT_DOUBLE_EQ(K12(0, 1), 150. / 6);
    EXPECT_DOUBLE_EQ(K12(1, 0), 100. / 6);
    EXPECT_DOUBLE_EQ(K12(0, 0), 0);
}

TEST(BlockMatrix, HoldsTheNeighboursOfANodeInOrder)
{
    // Two elements sharing the face 1, 2, 3: nodes 0 and 4 are not coupled.
    const TetMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, {{0, 1, 2, 3}, {1, 2, 3, 4}});
    BlockMatrix K = assembleRestStiffness(RestShape(mesh, Material()));
    EXPECT_EQ(K.nodeCount(), 5);
    EXPECT_EQ(K.m_rowStart, (std::vector<int>{0, 4, 9, 14, 19, 23}));
    EXPECT_EQ(std::vector<int>(K.m_column.begin(), K.m_column.begin() + 9),
              (std::vector<int>{0, 1, 2, 3, 0, 1, 2, 3, 4}));
    K.at(0, 3)(1, 2) = 5;
    EXPECT_EQ(K.m_block[3](1, 2), 5);
}

TEST(RestStiffnessFilled, ScalesWithTheFilledFraction)
{
    const TetMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
    const Mat3 full = assembleRestStiffness(RestShape(mesh, Material())).at(0, 1);
    const Mat3 quarter = assembleRestStiffness(RestShape(mesh, Material(), {0.25})).at(0, 1);
    EXPECT_LE(squaredNorm(quarter - 0.25 * full), 1e-30 * squaredNorm(full));
}

}  // namespace
}  // namespace bullet_fem
