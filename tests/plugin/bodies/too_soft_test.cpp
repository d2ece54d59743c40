// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies that are too soft for their own weight are flagged (docs/manual.md, How stiff must my body be).
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

constexpr double kDensityOfSoft = 500;                              // [kg/m3]
constexpr double kSlabLength = 2, kSlabWidth = 1, kSlabThick = .5;  // [m], along x, y and z

// A material with rho g `height` = `weightStrain` E.
btFemMaterial softMaterial(double weightStrain, double height)
{
    btFemMaterial material;
    material.m_density = btScalar(kDensityOfSoft);
    material.m_youngModulus = btScalar(kDensityOfSoft * kGravity * height / weightStrain);
    return material;
}

TetMesh slabMesh()
{
    return makeBox({kSlabLength, kSlabWidth, kSlabThick}, {4, 2, 2}, {0, 0, 3});
}

class TooSoft : public EachWorld
{
protected:
    btSoftBody& addSlab(const btFemMaterial& material)
    {
        btSoftBody* body = btFemHelpers::createFromTetMesh(m_world.info(), slabMesh());
        m_world.fem().setMaterial(body, material);
        return m_world.addSoft(body);
    }
    bool isFlagged(const btSoftBody& body, int steps = 2)
    {
        m_world.step(steps);
        EXPECT_TRUE(m_world.fem().isFem(&body));
        return (m_world.fem().stepReport(&body).m_flags & BT_FEM_TOO_SOFT) != 0;
    }

    FemWorld m_world{GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Worlds, TooSoft, eachWorld(), nameOfWorld);

TEST_P(TooSoft, IsFlaggedIfWeightExceedsHalfOfYoungsModulus)
{
    EXPECT_TRUE(isFlagged(addSlab(softMaterial(.505, kSlabThick))));
    EXPECT_FALSE(isFlagged(addSlab(softMaterial(.495, kSlabThick))));
}

TEST_P(TooSoft, IsNotFlaggedWithTheNeoHookeanLaw)
{
    btFemMaterial material = softMaterial(10, kSlabThick);
    material.m_law = btFemElasticLaw::neoHooke;
    EXPECT_FALSE(isFlagged(addSlab(material)));
}

TEST_P(TooSoft, FlagGoesAwayWithAnotherMaterial)
{
    btSoftBody& body = addSlab(softMaterial(1, kSlabThick));
    ASSERT_TRUE(isFlagged(body));
    btFemMaterial remedy = softMaterial(1, kSlabThick);
    remedy.m_law = btFemElasticLaw::neoHooke;
    m_world.fem().setMaterial(&body, remedy);
    EXPECT_FALSE(isFlagged(body));
    m_world.fem().setMaterial(&body, softMaterial(1, kSlabThick));
    EXPECT_TRUE(isFlagged(body));
    m_world.fem().setMaterial(&body, softMaterial(.4, kSlabThick));
    EXPECT_FALSE(isFlagged(body));
}

TEST_P(TooSoft, HeightIsTheRestShapesAlongGravityAsTheBodyLies)
{
    const btFemMaterial material = softMaterial(.6, kSlabLength);
    EXPECT_FALSE(isFlagged(addSlab(material)));
    btSoftBody* upright = btFemHelpers::createFromTetMesh(m_world.info(), slabMesh());
    upright->transform(btTransform(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI), btVector3(5, 0, 0)));
    m_world.fem().setMaterial(upright, material);
    EXPECT_TRUE(isFlagged(m_world.addSoft(upright)));
}

TEST_P(TooSoft, HeightFollowsTheOrientationWhenReevaluated)
{
    btSoftBody& body = addSlab(softMaterial(.61, kSlabLength));
    EXPECT_FALSE(isFlagged(body));
    body.transform(btTransform(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI)));
    m_world.fem().setMaterial(&body, softMaterial(.6, kSlabLength));
    EXPECT_TRUE(isFlagged(body));
}

TEST_P(TooSoft, FlagFollowsGravity)
{
    btSoftBody& body = addSlab(softMaterial(.8, kSlabThick));
    ASSERT_TRUE(isFlagged(body));
    m_world.setSoftGravity({0, 0, 0});
    EXPECT_FALSE(isFlagged(body));
    m_world.setSoftGravity({0, 0, btScalar(-.5 * kGravity)});
    EXPECT_FALSE(isFlagged(body));
    m_world.setSoftGravity({btScalar(-.5 * kGravity), 0, 0});  // the body is four times as long along x
    EXPECT_TRUE(isFlagged(body));
}

TEST_P(TooSoft, UnconnectedComponentsAreMeasuredSeparately)
{
    TetMesh lower = makeBox({1, 1, 1}, {2, 2, 2}, {0, 0, 3});
    std::vector<Vec3> places = lower.restPositions();
    std::vector<Tet> tets = lower.tets();
    const int count = lower.nodeCount();
    for (int i = 0; i < count; ++i) places.push_back(places[i] + Vec3{0, 0, 2});
    for (const Tet& t : lower.tets()) tets.push_back({t[0] + count, t[1] + count, t[2] + count, t[3] + count});
    const TetMesh both(std::move(places), std::move(tets));
    const auto flagged = [&](double weightStrain)
    {
        btSoftBody* body = btFemHelpers::createFromTetMesh(m_world.info(), both);
        m_world.fem().setMaterial(body, softMaterial(weightStrain, 1));
        return isFlagged(m_world.addSoft(body));
    };
    EXPECT_FALSE(flagged(.49));
    EXPECT_TRUE(flagged(.51));
}

TEST_P(TooSoft, MassesOfTheBodyCountWithoutADensity)
{
    btFemMaterial material = softMaterial(1, kSlabThick);
    material.m_density = 0;
    const auto flagged = [&](double share)
    {
        btSoftBody* body = btFemHelpers::createFromTetMesh(m_world.info(), slabMesh());
        m_world.fem().setMaterial(body, material);
        body->setTotalMass(btScalar(share * kDensityOfSoft * kSlabLength * kSlabWidth * kSlabThick));
        return isFlagged(m_world.addSoft(body));
    };
    EXPECT_TRUE(flagged(.51));
    EXPECT_FALSE(flagged(.49));
}

TEST_P(TooSoft, FlagFollowsTheMass)
{
    btSoftBody& body = addSlab(softMaterial(.4, kSlabThick));
    const btScalar mass = body.getTotalMass();
    EXPECT_FALSE(isFlagged(body));
    body.setTotalMass(2 * mass);
    EXPECT_TRUE(isFlagged(body));
    body.setTotalMass(mass);
    EXPECT_FALSE(isFlagged(body));
}

TEST_P(TooSoft, RegionsCountByTheHarmonicMeanAndNeoHookeanOnesAsRigid)
{
    const auto flagged = [&](const btFemMaterial& left, const btFemMaterial& right)
    {
        btSoftBody* body = btFemHelpers::createFromTetMesh(m_world.info(), slabMesh());
        m_world.fem().setMaterials(body, [&](const btVector3& c) { return c.x() < kSlabLength / 2 ? left : right; });
        return isFlagged(m_world.addSoft(body));
    };
    EXPECT_TRUE(flagged(softMaterial(.8, kSlabThick), softMaterial(.22, kSlabThick)));
    EXPECT_FALSE(flagged(softMaterial(.8, kSlabThick), softMaterial(.18, kSlabThick)));
    btFemMaterial neoHooke = softMaterial(3, kSlabThick);
    neoHooke.m_law = btFemElasticLaw::neoHooke;
    EXPECT_TRUE(flagged(softMaterial(1.02, kSlabThick), neoHooke));
    EXPECT_FALSE(flagged(softMaterial(.98, kSlabThick), neoHooke));
}

TEST_P(TooSoft, OrthotropicMaterialsCountAlongGravity)
{
    btFemMaterial fibres = btFemMaterial::transverselyIsotropic(1, 1, btScalar(.3), btScalar(.3), 1);
    const auto flagged = [&](double alongFibres, double acrossFibres, const btVector3& along)
    {
        const auto young = [](double weightStrain) { return softMaterial(weightStrain, kSlabThick).m_youngModulus; };
        fibres = btFemMaterial::transverselyIsotropic(young(alongFibres), young(acrossFibres), btScalar(.3),
                                                      btScalar(.3), young(acrossFibres) / 3);
        fibres.m_density = btScalar(kDensityOfSoft);
        fibres.m_orthotropic.m_along = along;
        fibres.m_orthotropic.m_across = btVector3(0, 1, 0);
        return isFlagged(addSlab(fibres));
    };
    EXPECT_FALSE(flagged(.1, .8, {0, 0, 1}));
    EXPECT_TRUE(flagged(.1, .8, {1, 0, 0}));
    EXPECT_TRUE(flagged(.52, .8, {0, 0, 1}));
}

TEST_P(TooSoft, RelaxingMaterialsCountWithTheirRelaxedModulus)
{
    btFemMaterial material = softMaterial(.3, kSlabThick);
    EXPECT_FALSE(isFlagged(addSlab(material)));
    material.m_relaxation[0] = {btScalar(.5), 1};
    EXPECT_TRUE(isFlagged(addSlab(material)));
}

TEST_P(TooSoft, FlagStaysWhileTheBodySleeps)
{
    btSoftBody& body = addSlab(softMaterial(.6, kSlabThick));
    ASSERT_TRUE(isFlagged(body));
    body.forceActivationState(ISLAND_SLEEPING);
    EXPECT_TRUE(isFlagged(body));
}

}  // namespace
}  // namespace bullet_fem
