// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

const btScalar kNaN = std::numeric_limits<btScalar>::quiet_NaN();
const btScalar kInfinity = std::numeric_limits<btScalar>::infinity();

/// A cube at rest on a plane, to which the test then writes a bad value.
class Scene
{
public:
    explicit Scene(WorldClass worldClass) : m_world(worldClass), m_fem(m_world.fem())
    {
        m_world.addPlane();
        m_cube = &m_world.addSoft(btFemHelpers::createBox(m_world.info(), btVector3(0, 0, btScalar(0.52)),
                                                          btVector3(0.5, 0.5, 0.5), btScalar(0.25)));
        m_world.step(20);
    }
    int flags() const { return m_fem.stepReport(m_cube).m_flags; }

    FemWorld m_world;
    btFemSoftBodySolver& m_fem;
    btSoftBody* m_cube;
};

struct BadValue
{
    const char* m_name;
    void (*m_write)(btSoftBody::Node&);
    int m_flag;
};

class BadNodeValue : public EachWorldWith<BadValue>
{
};

TEST_P(BadNodeValue, IsPutBackFlaggedAndDoesNotSpread)
{
    Scene good(worldClass()), bad(worldClass());
    value().m_write(bad.m_cube->m_nodes[30]);
    good.m_world.step();
    bad.m_world.step();
    EXPECT_TRUE(bad.flags() & value().m_flag);
    EXPECT_TRUE(allFinite(*bad.m_cube));
    EXPECT_EQ(bitsOf(*bad.m_cube), bitsOf(*good.m_cube));  // bitwise equal to a cube without the write
    EXPECT_EQ(bad.m_cube->m_nodes[30].m_im, good.m_cube->m_nodes[30].m_im);
    good.m_world.step(60);
    bad.m_world.step(60);
    EXPECT_EQ(bad.flags(), 0);
    EXPECT_EQ(bitsOf(*bad.m_cube), bitsOf(*good.m_cube));
}

INSTANTIATE_TEST_SUITE_P(
    Values, BadNodeValue,
    testing::Combine(
        eachWorld(),
        testing::Values(
            BadValue{"positionNaN", [](btSoftBody::Node& n) { n.m_x.setY(kNaN); }, BT_FEM_RESTORED},
            BadValue{"positionInfinite", [](btSoftBody::Node& n) { n.m_x.setX(-kInfinity); }, BT_FEM_RESTORED},
            BadValue{"positionTooFar", [](btSoftBody::Node& n) { n.m_x.setX(btScalar(1e7)); }, BT_FEM_RESTORED},
            BadValue{"velocityNaN", [](btSoftBody::Node& n) { n.m_v.setZ(kNaN); }, BT_FEM_RESTORED},
            BadValue{"velocityInfinite", [](btSoftBody::Node& n) { n.m_v.setZ(kInfinity); }, BT_FEM_RESTORED},
            BadValue{"forceNaN", [](btSoftBody::Node& n) { n.m_f.setX(kNaN); }, BT_FEM_RESTORED},
            BadValue{"forceInfinite", [](btSoftBody::Node& n) { n.m_f.setX(kInfinity); }, BT_FEM_RESTORED},
            BadValue{"inverseMassNaN", [](btSoftBody::Node& n) { n.m_im = kNaN; }, BT_FEM_BAD_MASS},
            BadValue{"inverseMassInfinite", [](btSoftBody::Node& n) { n.m_im = kInfinity; }, BT_FEM_BAD_MASS},
            BadValue{"inverseMassNegative", [](btSoftBody::Node& n) { n.m_im = -1; }, BT_FEM_BAD_MASS})),
    nameOfWorldWith([](const BadValue& bad) { return bad.m_name; }));

class BadValues : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, BadValues, eachWorld(), nameOfWorld);

class BadSteps : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, BadSteps, eachWorld(), nameOfWorld);

TEST_P(BadValues, NaNInAllNodesIsPutBackToo)
{
    Scene good(GetParam()), bad(GetParam());
    for (int i = 0; i < bad.m_cube->m_nodes.size(); ++i)
    {
        btSoftBody::Node& node = bad.m_cube->m_nodes[i];
        node.m_x = node.m_v = node.m_f = btVector3(kNaN, kNaN, kNaN);
    }
    good.m_world.step();
    bad.m_world.step();
    EXPECT_TRUE(bad.flags() & BT_FEM_RESTORED);
    EXPECT_EQ(bitsOf(*bad.m_cube), bitsOf(*good.m_cube));
    EXPECT_TRUE(bad.m_cube->isActive());
}

TEST_P(BadValues, NonFiniteGravityIsFlaggedAndIgnored)
{
    Scene scene(GetParam());
    scene.m_world.setSoftGravity(btVector3(0, 0, kNaN));
    scene.m_world.step(3);
    EXPECT_TRUE(scene.flags() & BT_FEM_RESTORED);
    EXPECT_TRUE(allFinite(*scene.m_cube));
}

TEST_P(BadValues, InfiniteMassesAreReplacedByVolumeShares)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody* made =
        btFemHelpers::createBox(world.info(), btVector3(0, 0, 0), btVector3(0.5, 0.5, 0.5), btScalar(0.25));
    made->setTotalMass(50, true);  // by face area: inner nodes get no mass, and an infinite inverse mass
    btSoftBody& cube = world.addSoft(made);
    world.step();
    EXPECT_TRUE(fem.stepReport(&cube).m_flags & BT_FEM_BAD_MASS);
    world.step(20);
    EXPECT_TRUE(allFinite(cube));
    for (int i = 0; i < cube.m_nodes.size(); ++i) EXPECT_NEAR(cube.m_nodes[i].m_v.z(), -kGravity * 21 * kStep, 0.01);
}

TEST_P(BadSteps, AreFlaggedAndTheBodyStandsStill)
{
    for (const btScalar bad : {btScalar(0), kNaN, btScalar(-0.1), btScalar(2), btScalar(1e-9), kInfinity})
    {
        SCOPED_TRACE(bad);
        Scene scene(GetParam());
        const std::vector<btScalar> before = bitsOf(*scene.m_cube);
        scene.m_fem.predictMotion(bad);
        scene.m_fem.solveConstraints(bad);
        scene.m_fem.updateSoftBodies();
        EXPECT_EQ(scene.flags(), BT_FEM_BAD_STEP);
        EXPECT_EQ(bitsOf(*scene.m_cube), before);
    }
}

TEST_P(BadSteps, AreNotThoseAtTheBounds)
{
    for (const btScalar allowed : {btScalar(1e-6), btScalar(1)})
    {
        Scene scene(GetParam());
        scene.m_fem.predictMotion(allowed);
        EXPECT_EQ(scene.flags() & BT_FEM_BAD_STEP, 0) << allowed;
    }
}

// The float nearest to 1e-6 is below it.
TEST_P(BadSteps, LimitingStepsPrepareAndMoveABody)
{
    for (const btScalar allowed : {btScalar(1e-6), btScalar(1)})
    {
        FemWorld world(GetParam());
        btSoftBody& cube = world.addSoft(
            btFemHelpers::createBox(world.info(), btVector3(0, 0, 0), btVector3(0.5, 0.5, 0.5), btScalar(0.5)));
        std::string why;
        EXPECT_TRUE(world.fem().prepare(&cube, allowed, &why)) << why;
        world.bullet().stepSimulation(allowed, 0);
        EXPECT_EQ(world.fem().stepReport(&cube).m_flags, 0) << allowed;
        EXPECT_NEAR(cube.m_nodes[0].m_v.z() / (-kGravity * allowed), 1, 1e-4) << allowed;
    }
}

TEST_P(BadSteps, LeaveBodiesFiniteAfterABadWorldStep)
{
    for (const btScalar bad : {btScalar(0), kNaN, btScalar(5)})
    {
        SCOPED_TRACE(bad);
        FemWorld world(GetParam());
        btSoftBody& cube = world.addSoft(
            btFemHelpers::createBox(world.info(), btVector3(0, 0, 0), btVector3(0.5, 0.5, 0.5), btScalar(0.5)));
        world.step(5);
        world.bullet().stepSimulation(bad, 0);
        world.step(5);
        EXPECT_TRUE(allFinite(cube));
        EXPECT_NEAR(velocityOf(cube).z, -kGravity * 10 * kStep, 1e-4);
    }
}

TEST_P(BadSteps, ABodyFirstSteppedWithOneIsSetUpByTheNext)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& cube = world.addSoft(
        btFemHelpers::createBox(world.info(), btVector3(0, 0, 0), btVector3(0.5, 0.5, 0.5), btScalar(0.5)));
    world.bullet().stepSimulation(3, 0);
    EXPECT_TRUE(allFinite(cube));
    world.step(2);
    EXPECT_TRUE(fem.isFem(&cube));
    EXPECT_EQ(fem.stepReport(&cube).m_flags, 0);
}

}  // namespace
}  // namespace bullet_fem
