// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

btSoftBody* makeCube(SoftWorld& world, btScalar cell = btScalar(0.25))
{
    return btFemHelpers::createBox(world.info(), btVector3(0, 0, 0), btVector3(0.5, 0.5, 0.5), cell);
}

btFemMaterial softMaterial(btScalar youngModulus)
{
    btFemMaterial material;
    material.m_youngModulus = youngModulus;
    material.m_poissonRatio = 0;
    material.m_density = 1000;
    return material;
}

class Matching : public EachWorldWith<double>
{
};

std::string shareName(double share)
{
    return "kMT" + std::to_string(int(std::lround(100 * share))) + "Percent";
}

// A body of nearly zero stiffness moves as free nodes in Bullet do, to the rounding of floats.
TEST_P(Matching, MovesNodesTheSameShareOfTheWayAsBulletDoes)
{
    btDefaultSoftBodySolver plain;
    FemWorld world(worldClass(), btVector3(0, 0, -1));
    btFemSoftBodySolver& fem = world.fem();
    SoftWorld other(plain, btVector3(0, 0, -1));
    btSoftBody& body = world.addSoft(makeCube(world));
    btSoftBody& twin = other.addSoft(makeCube(other));
    fem.setMaterial(&body, softMaterial(1));
    twin.setTotalMass(body.getTotalMass());
    for (btSoftBody* b : {&body, &twin})
    {
        for (int i = 0; i < b->m_nodes.size(); ++i) b->m_nodes[i].m_im = 1;  // Bullet's have to be those of the pose
        b->setPose(false, true);
        b->m_cfg.kMT = btScalar(value());
        b->m_cfg.collisions = 0;
        b->m_bUpdateRtCst = false;
    }
    world.step();
    other.step();
    for (btSoftBody* b : {&body, &twin})
        for (int i = 0; i < b->m_nodes.size(); ++i)
            b->m_nodes[i].m_x += btVector3(btScalar(0.1) * b->m_nodes[i].m_x.x(), 0, btScalar(0.02 * (i % 3)));
    for (int k = 0; k < 20; ++k)
    {
        world.step();
        other.step();
        double furthest = 0;
        for (int i = 0; i < body.m_nodes.size(); ++i)
            furthest = std::max(furthest, double((body.m_nodes[i].m_x - twin.m_nodes[i].m_x).length()));
        EXPECT_LT(furthest, 1e-3) << k;  // of the 0.05 m by which they were moved
    }
}

// It falls, flies and spins as without pose matching.
TEST_P(Matching, LeavesRigidMotionAndMomentumAlone)
{
    FemWorld world(worldClass());
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody* made = makeCube(world);
    made->setPose(false, true);
    made->m_cfg.kMT = btScalar(value());
    for (int i = 0; i < made->m_nodes.size(); ++i)
        made->m_nodes[i].m_v = btVector3(2, 0, 0) + btVector3(1, 0, 3).cross(made->m_nodes[i].m_x);
    btSoftBody& cube = world.addSoft(made);
    const Vec3 spin = motionOf(cube).m_angular;
    world.step(60);
    EXPECT_LT(norm(velocityOf(cube) - Vec3{2, 0, -kGravity * 60 * kStep}), 1e-3);
    const Vec3 now = motionOf(cube).m_angular - massOf(cube) * cross(centerOf(cube), velocityOf(cube));
    EXPECT_LT(norm(now - spin), 2e-3 * norm(spin));
    EXPECT_EQ(fem.stepReport(&cube).m_flags, 0);
}

TEST_P(Matching, LeavesTheWeightToTheFloor)
{
    FemWorld world(worldClass());
    btFemSoftBodySolver& fem = world.fem();
    world.addPlane(btScalar(-0.501));
    btSoftBody& cube = world.addSoft(makeCube(world));
    cube.setPose(false, true);
    cube.m_cfg.kMT = btScalar(value());
    world.step(180);
    EXPECT_NEAR(impulseOn(fem, cube).z / kStep, massOf(cube) * kGravity, 2e-3 * massOf(cube) * kGravity);
    EXPECT_LT(fastestNode(cube), 1e-3);
}

// Pinned nodes hold the pose: a soft body below them sags by g h^2 (1 - kMT) / kMT, as in Bullet.
TEST_P(Matching, HoldsAPinnedBodyUpAsBulletDoes)
{
    FemWorld world(worldClass());
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody* made = makeCube(world, btScalar(0.125));
    fem.setMaterial(made, softMaterial(500));
    for (int i = 0; i < made->m_nodes.size(); ++i)
        if (made->m_nodes[i].m_x.z() > btScalar(0.499)) made->setMass(i, 0);
    made->setPose(false, true);
    made->m_cfg.kMT = btScalar(value());
    made->m_cfg.kDP = btScalar(0.02);
    btSoftBody& cube = world.addSoft(made);
    world.step(400);
    const double sag = kGravity * kStep * kStep * (1 - value()) / value();
    EXPECT_NEAR(-0.5 - lowestHeight(cube), sag, 0.02 * sag);
}

INSTANTIATE_TEST_SUITE_P(Pose, Matching,
                         testing::Combine(testing::Values(WorldClass::softRigid), testing::Values(0.1, 0.5, 0.9)),
                         nameOfWorldWith(shareName));
INSTANTIATE_TEST_SUITE_P(OtherWorlds, Matching,
                         testing::Combine(testing::Values(WorldClass::softMultiBody, WorldClass::deformable),
                                          testing::Values(0.5)),
                         nameOfWorldWith(shareName));

class Pose : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, Pose, eachWorld(), nameOfWorld);

// A pendulum: the pose rotates with the swing without damping it.
TEST_P(Pose, DoesNotBrakeAPendulum)
{
    double height[2];
    for (const int k : {0, 1})
    {
        FemWorld world(GetParam(), implicitEuler());
        btFemSoftBodySolver& fem = world.fem();
        btSoftBody* made = makeCube(world);
        fem.setMaterial(made, softMaterial(btScalar(1e8)));  // nearly rigid with and without the pose
        made->setMass(0, 0);
        made->setPose(false, true);
        made->m_cfg.kMT = k == 0 ? btScalar(0) : btScalar(0.3);
        btSoftBody& cube = world.addSoft(made);
        world.step(40);
        height[k] = centerOf(cube).z;
    }
    EXPECT_LT(height[0], -0.1);
    EXPECT_NEAR(height[1], height[0], 0.01 * std::fabs(height[0]));
}

/// Momenta about (-0.5, -0.5, -0.5), where a cube is fixed to a hinge along z, or at one node.
class HungCube : public testing::TestWithParam<int>
{
protected:
    /// Share of a stone's angular momentum about the pins that cube and stone keep after the stone hits the far side.
    Vec3 keptShare(btScalar kMT) const
    {
        btFemSoftBodySolver fem;
        SoftWorld world(fem, btVector3(0, 0, 0));
        btSoftBody* made = makeCube(world);
        fem.setMaterial(made, softMaterial(btScalar(1e6)));
        int pins = 0;
        for (int i = 0; i < made->m_nodes.size(); ++i)
        {
            const btVector3& x = made->m_nodes[i].m_x;
            const bool onEdge = x.x() < btScalar(-0.49) && x.y() < btScalar(-0.49);
            if (!onEdge || (GetParam() == 1 && x.z() > btScalar(-0.49))) continue;
            made->setMass(i, 0);
            ++pins;
        }
        EXPECT_EQ(pins, GetParam());
        made->setPose(false, true);
        made->m_cfg.kMT = kMT;
        btSoftBody& cube = world.addSoft(made);
        RigidSettings settings{100, at(btScalar(0.3), btScalar(-0.72), btScalar(0.1))};
        settings.m_velocity = {0, 2, 0};
        const btRigidBody& stone = world.addRigid(new btSphereShape(btScalar(0.2)), settings);
        const auto total = [&]
        {
            Motion sum = motionOf(cube);
            sum += motionOf(stone);
            return sum.m_angular - cross(Vec3{-0.5, -0.5, -0.5}, sum.m_linear);
        };
        const Vec3 before = total();
        world.step(30);
        EXPECT_GT(norm(motionOf(cube).m_angular), 0.1 * norm(before));
        const Vec3 after = total();
        return (1 / norm(before)) * (after - before);
    }
};

TEST_P(HungCube, KeepsImpactMomentumForAnyPoseMatching)
{
    for (const double kMT : {0.0, 0.3, 0.9})
    {
        const Vec3 lost = keptShare(btScalar(kMT));
        EXPECT_LT(GetParam() == 1 ? norm(lost) : std::fabs(lost.z), 0.01) << kMT;  // the hinge bears the rest
    }
}

INSTANTIATE_TEST_SUITE_P(Pose, HungCube, testing::Values(1, 5),
                         [](const auto& test) { return test.param == 1 ? "OnANode" : "OnAHinge"; });

TEST_P(Pose, IsIgnoredWithoutItsFrameAndForOtherNumbersOfNodes)
{
    std::vector<btScalar> bits[3];
    for (const int k : {0, 1, 2})
    {
        FemWorld world(GetParam());
        btSoftBody& cube = world.addSoft(makeCube(world));
        cube.setMass(0, 0);
        if (k == 1) cube.setPose(true, false);
        if (k == 2) cube.setPose(true, true);
        if (k == 2) cube.m_pose.m_pos.pop_back();
        cube.m_cfg.kMT = btScalar(0.5);
        world.step(20);
        bits[k] = bitsOf(cube);
    }
    EXPECT_EQ(bits[0], bits[1]);
    EXPECT_EQ(bits[0], bits[2]);
}

// --- Pressure and volume: forces of Bullet's along the node normals ---

/// A free unit cube that settles.
class FreeCube
{
public:
    explicit FreeCube(WorldClass worldClass)
        : m_world(worldClass, btVector3(0, 0, 0)), m_body(&m_world.addSoft(makeCube(m_world)))
    {
        m_material.m_youngModulus = btScalar(1e6);
        m_material.m_poissonRatio = btScalar(0.3);
        m_material.m_density = 1000;
        m_material.m_massDamping = 5;
        m_world.fem().setMaterial(m_body, m_material);
    }

    btSoftBody& body() { return *m_body; }
    double bulkModulus() const { return 1e6 / (3 * (1 - 2 * 0.3)); }

    /// Relative change of volume, once settled.
    double expansion()
    {
        m_world.step(300);
        return double(m_body->getVolume()) - 1;
    }

    /// The virial pressure of forces n_i a_i q, over q; it alone determines the mean strain.
    double virialShare() const
    {
        Vec3 middle = centerOf(*m_body);
        double sum = 0;
        for (int i = 0; i < m_body->m_nodes.size(); ++i)
            sum += m_body->m_nodes[i].m_area * dot(vec3(m_body->m_nodes[i].m_n), vec3(m_body->m_nodes[i].m_x) - middle);
        return sum / (3 * m_body->getVolume());
    }

private:
    FemWorld m_world;
    btFemMaterial m_material;
    btSoftBody* m_body;
};

class Pressure : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, Pressure, eachWorld(), nameOfWorld);

class VolumeConservation : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, VolumeConservation, eachWorld(), nameOfWorld);

// Linear expansion is p (1 - 2 nu) / E, and volume expansion three times that.
TEST_P(Pressure, ExpandsACubeByItsFormula)
{
    FreeCube cube(GetParam());
    cube.body().m_cfg.kPR = 4000;
    const double expansion = cube.expansion();
    const double p = 4000 * cube.virialShare() / cube.body().getVolume();
    EXPECT_GT(p, 1000);
    EXPECT_NEAR(expansion, 3 * p * (1 - 2 * 0.3) / 1e6, 0.01 * expansion);
}

// kVC is a bulk modulus that adds to the material's.
TEST_P(VolumeConservation, StiffensTheCubeAgainstPressureByItsFormula)
{
    FreeCube cube(GetParam());
    cube.body().setPose(true, false);
    cube.body().m_cfg.kVC = btScalar(1e6);
    cube.body().m_cfg.kPR = 8000;
    const double expansion = cube.expansion(), V = cube.body().getVolume(), share = cube.virialShare();
    const double expected = share * 8000 / V / (cube.bulkModulus() + share * 1e6);
    EXPECT_NEAR(expansion, expected, 0.01 * expected);
    EXPECT_LT(expected, 0.8 * share * 8000 / V / cube.bulkModulus());  // it has an effect
}

}  // namespace
}  // namespace bullet_fem
