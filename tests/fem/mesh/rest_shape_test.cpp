// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/rest_shape.h"

#include <gtest/gtest.h>

#include <numeric>

#include "bullet_fem/fem/mesh/generators.h"
#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/test_constants.h"

namespace bullet_fem
{
namespace
{

TetMesh unitTet()
{
    return TetMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
}

Material material(double density = 1200)
{
    Material m;
    m.m_youngModulus = 260;  // lambda 150, mu 100 Pa
    m.m_poissonRatio = 0.3;
    m.m_density = density;
    return m;
}

double totalMass(const RestShape& shape)
{
    return std::accumulate(shape.m_lumpedMass.begin(), shape.m_lumpedMass.end(), 0.0);
}

TEST(RestShape, UnitTetrahedronMatchesHandValues)
{
    const RestShape shape(unitTet(), material());
    ASSERT_EQ(shape.m_elements.size(), 1u);
    EXPECT_DOUBLE_EQ(shape.m_elements[0].m_volume, 1. / 6);
    EXPECT_DOUBLE_EQ(shape.m_elements[0].m_lambdaVolume, 25);
    EXPECT_DOUBLE_EQ(shape.m_elements[0].m_muVolume, 100. / 6);
    EXPECT_LE(squaredNorm(shape.m_elements[0].m_DmInverse - Mat3::identity()), 1e-30);
    ASSERT_EQ(shape.m_lumpedMass.size(), 4u);
    for (double m : shape.m_lumpedMass) EXPECT_DOUBLE_EQ(m, 50);  // 1200 / 6 / 4
}

TEST(RestShape, GradientsInvertTheEdgesOfEveryElement)
{
    const RestShape shape(makeBox({1, 2, 0.3}, {2, 3, 2}, {5, -7, 1}), material());
    for (int e = 0; e < shape.m_mesh.tetCount(); ++e)
    {
        const Tet& tet = shape.m_mesh.tets()[e];
        const std::vector<Vec3>& X = shape.m_mesh.restPositions();
        const Mat3 Dm = Mat3::fromColumns(X[tet[1]] - X[tet[0]], X[tet[2]] - X[tet[0]], X[tet[3]] - X[tet[0]]);
        EXPECT_LE(squaredNorm(shape.m_elements[e].m_DmInverse * Dm - Mat3::identity()), 1e-26) << e;
        EXPECT_DOUBLE_EQ(shape.m_elements[e].m_volume, shape.m_mesh.tetVolume(e)) << e;
    }
}

TEST(RestShape, MassesAddUpToDensityTimesVolume)
{
    const RestShape shape(makeBox({1, 2, 0.3}, {2, 3, 2}), material());
    EXPECT_NEAR(totalMass(shape), 1200 * 0.6, 1200 * 0.6 * 1e-14);
    for (double m : shape.m_lumpedMass) EXPECT_GT(m, 0);
}

TEST(RestShape, MassesWithoutADensityAreOfUnitDensity)
{
    EXPECT_NEAR(totalMass(RestShape(makeBox({1, 2, 0.3}, {2, 3, 2}), material(0))), 0.6, 1e-14);
}

TEST(RestShape, FilledFractionsScaleMassAndStiffnessMassScaleOnlyMasses)
{
    const RestShape shape(unitTet(), material(), {0.25}, 3);
    EXPECT_DOUBLE_EQ(shape.m_elements[0].m_volume, 0.25 / 6);
    EXPECT_DOUBLE_EQ(shape.m_elements[0].m_lambdaVolume, 25 * 0.25);
    EXPECT_DOUBLE_EQ(shape.m_elements[0].m_muVolume, 100 * 0.25 / 6);
    for (double m : shape.m_lumpedMass) EXPECT_DOUBLE_EQ(m, 50 * 0.25 * 3);
}

TEST(RestShapeInput, RejectsInvalidMassScales)
{
    const auto make = [](double scale) { return [scale] { RestShape(unitTet(), material(), {}, scale); }; };
    expectRejected(make(0), {"mass scale 0", "(0, inf)"});
    expectRejected(make(-2), {"mass scale -2", "(0, inf)"});
    expectRejected(make(-1e-9), {"mass scale -1e-09", "(0, inf)"});
    expectRejected(make(kNaN), {"mass scale nan", "(0, inf)"});
    expectRejected(make(kInf), {"mass scale inf", "(0, inf)"});
}

TEST(RestShapeInput, RejectsInvalidFilledFractions)
{
    const auto make = [](std::vector<double> filled) {
        return [filled] { RestShape(makeBox({1, 1, 1}, {1, 1, 1}), material(), filled); };
    };
    expectRejected(make({1, 1}), {"2 given", "5 elements", "one each or none"});
    expectRejected(make({1, 1, 1, 1, 1, 1}), {"6 given", "5 elements"});
    expectRejected(make({1, 0, 1, 1, 1}), {"element 1 is 0", "(0, 1]", "drop empty elements"});
    expectRejected(make({1, 1, -0.5, 1, 1}), {"element 2 is -0.5", "(0, 1]"});
    expectRejected(make({1, 1, 1, 1.25, 1}), {"element 3 is 1.25", "(0, 1]"});
    expectRejected(make({1, 1, 1, 1, kNaN}), {"element 4 is nan", "(0, 1]"});
}

TEST(RestShapeInput, RejectsInvalidMaterials)
{
    Material bad = material();
    bad.m_poissonRatio = 0.5;
    expectRejected([&] { RestShape(unitTet(), bad); }, {"Poisson", "0.5", "[0, 0.499]"});
}

}  // namespace
}  // namespace bullet_fem
