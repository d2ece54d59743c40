// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <functional>

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

/// A unit cube, 1 m3, on a floor that measures its weight.
class Scales
{
public:
    explicit Scales(WorldClass worldClass) : m_world(worldClass)
    {
        m_world.addPlane();
        m_body = btFemHelpers::createBox(m_world.info(), btVector3(0, 0, btScalar(0.501)), btVector3(0.5, 0.5, 0.5),
                                         btScalar(0.25));
    }

    btSoftBody& body() { return *m_body; }
    btFemSoftBodySolver& fem() { return m_world.fem(); }
    SoftWorld& world() { return m_world; }
    void put() { m_world.addSoft(m_body); }

    /// Contact force on the floor at rest over g [kg].
    double weigh()
    {
        m_world.step(240);
        return impulseOn(m_world.fem(), *m_body).z / kStep / kGravity;
    }

private:
    FemWorld m_world;
    btSoftBody* m_body;
};

struct Setter
{
    const char* m_name;
    std::function<void(btSoftBody&)> m_set;
    double m_weighs;  // [kg]
    int m_flags = 0;  // before it is set
};

class MassSetter : public EachWorldWith<Setter>
{
};

TEST_P(MassSetter, SetsTheWeightOfTheBody)
{
    Scales scales(worldClass());
    value().m_set(scales.body());
    scales.put();
    scales.world().step();
    EXPECT_EQ(scales.fem().stepReport(&scales.body()).m_flags, value().m_flags);
    EXPECT_NEAR(scales.weigh(), value().m_weighs, 1e-3 * value().m_weighs);
    EXPECT_NEAR(massOf(scales.body()), value().m_weighs, 1e-4 * value().m_weighs);  // and the node masses agree
}

TEST_P(MassSetter, SetsTheWeightOfTheBodyInMidRun)
{
    Scales scales(worldClass());
    scales.put();
    EXPECT_NEAR(scales.weigh(), 1000, 1);
    value().m_set(scales.body());
    scales.world().step();
    const int about = BT_FEM_STALE_FACTOR | BT_FEM_REFACTORED | BT_FEM_REFACTOR_PAYS;
    EXPECT_EQ(scales.fem().stepReport(&scales.body()).m_flags & ~about, value().m_flags);
    EXPECT_NEAR(scales.weigh(), value().m_weighs, 0.02 * value().m_weighs);  // minus the penetration
    EXPECT_NEAR(scales.weigh(), massOf(scales.body()), 1e-3 * massOf(scales.body()));
}

INSTANTIATE_TEST_SUITE_P(
    Masses, MassSetter,
    testing::Combine(eachWorld(),
                     testing::Values(Setter{"setTotalMass", [](btSoftBody& b) { b.setTotalMass(300); }, 300},
                                     Setter{"setVolumeMass", [](btSoftBody& b) { b.setVolumeMass(300); }, 300},
                                     // Bullet adds every element's volume four times.
                                     Setter{"setVolumeDensityIsFourTimesTheDensity",
                                            [](btSoftBody& b) { b.setVolumeDensity(300); }, 1200},
                                     // Bullet gives inner nodes no mass.
                                     Setter{"setTotalMassFromFaces", [](btSoftBody& b) { b.setTotalMass(300, true); },
                                            300, BT_FEM_BAD_MASS},
                                     Setter{"setTotalDensity", [](btSoftBody& b) { b.setTotalDensity(300); }, 300,
                                            BT_FEM_BAD_MASS},
                                     Setter{"setMassOfEveryNode",
                                            [](btSoftBody& b)
                                            {
                                                for (int i = 0; i < b.m_nodes.size(); ++i)
                                                    b.setMass(i, btScalar(300.0 / b.m_nodes.size()));
                                            },
                                            300})),
    nameOfWorldWith([](const Setter& setter) { return setter.m_name; }));

class Masses : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, Masses, eachWorld(), nameOfWorld);

// Inner nodes accelerate like the others, not like massless ones.
TEST_P(Masses, FaceMassesAreDistributedByVolume)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, 0));
    std::vector<double> before;
    for (int i = 0; i < cube.m_nodes.size(); ++i) before.push_back(1 / double(cube.m_nodes[i].m_im));
    cube.setTotalMass(500, true);
    world.step();
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        EXPECT_NEAR(1 / double(cube.m_nodes[i].m_im), before[i] / 2, 1e-4 * before[i]) << i;
}

// Without faces Bullet makes all masses NaN, and the requested mass is lost.
TEST_P(Masses, MissingFacesGiveTheMassesOfWater)
{
    Scales scales(GetParam());
    scales.body().m_faces.clear();
    scales.body().setTotalMass(300, true);
    scales.put();
    scales.world().step();
    EXPECT_EQ(scales.fem().stepReport(&scales.body()).m_flags, BT_FEM_BAD_MASS);
    EXPECT_NEAR(scales.weigh(), 1000, 1);
}

/// A bar of 1 x 0.25 x 0.25 m, nu = 0, that hangs from z = 0.
struct Hanging
{
    explicit Hanging(WorldClass worldClass) : m_world(worldClass)
    {
        m_body = btFemHelpers::createBox(m_world.info(), btVector3(0, 0, btScalar(-0.5)),
                                         btVector3(btScalar(0.125), btScalar(0.125), btScalar(0.5)), btScalar(0.125));
        btFemMaterial material;
        material.m_youngModulus = btScalar(2e6);
        material.m_poissonRatio = 0;
        material.m_massDamping = 5;
        material.m_density = 1000;
        m_world.fem().setMaterial(m_body, material);
        for (int i = 0; i < m_body->m_nodes.size(); ++i)
            if (m_body->m_nodes[i].m_x.z() > btScalar(-1e-3)) m_body->setMass(i, 0);
        m_world.addSoft(m_body);
    }

    /// Under its own weight, settled [m].
    double sag()
    {
        m_world.step(300);
        return -1 - lowestHeight(*m_body);
    }

    FemWorld m_world;
    btSoftBody* m_body;
};

// The clamped bar's free nodes have 15/16 of its mass; its sag is m g L / (2 E A) with the whole mass.
TEST_P(Masses, SetWhilePinnedAreWeighedAndThePinsStay)
{
    Hanging bar(GetParam());
    const double freeShare = massOf(*bar.m_body) / 62.5;
    const double expected = 62.5 * kGravity / (2 * 2e6 * 0.0625);
    EXPECT_NEAR(bar.sag(), expected, 0.01 * expected);
    bar.m_body->setTotalMass(btScalar(3 * 62.5 * freeShare));  // of the nodes that are not pinned
    EXPECT_NEAR(bar.sag(), 3 * expected, 0.01 * 3 * expected);
    for (int i = 0; i < bar.m_body->m_nodes.size(); ++i)
        EXPECT_EQ(bar.m_body->m_nodes[i].m_im == 0, bar.m_body->m_nodes[i].m_x.z() > -1e-3) << i;
}

// A released node with another mass: the body falls freely, with that mass and its own shape.
TEST_P(Masses, ANodeReleasedWithANewMassHasThatMass)
{
    Hanging bar(GetParam());
    bar.sag();
    double pinned = 0;
    for (int i = 0; i < bar.m_body->m_nodes.size(); ++i)
        if (bar.m_body->m_nodes[i].m_im == 0)
        {
            bar.m_body->setMass(i, 2);
            pinned += 2;
        }
    const double mass = massOf(*bar.m_body);
    EXPECT_GT(pinned, 10);
    bar.m_world.setSoftGravity(btVector3(0, 0, 0));
    bar.m_body->m_nodes[0].m_f = btVector3(btScalar(60 * mass), 0, 0);
    bar.m_world.step();
    const double h = kStep;
    EXPECT_NEAR(velocityOf(*bar.m_body).x, 60 * h / (1 + 5 * h), 1e-3);
}

}  // namespace
}  // namespace bullet_fem
