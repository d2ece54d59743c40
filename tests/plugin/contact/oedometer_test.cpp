// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <array>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

struct OedometerCase
{
    const char* m_name;
    double m_poissonRatio;  // [-]
    double m_density;       // of the cube of 1 m3 [kg/m3]
    double m_mass;          // of the heavy box [kg]
    int m_stepsPerSecond;
};

/// A soft cube of 1 m in a frictionless pit of exactly its size, under a heavy dynamic box, in monolithic coupling.
class Oedometer : public testing::TestWithParam<OedometerCase>
{
protected:
    Oedometer()
    {
        m_floor = &addStill(at(0, 0, -1));
        m_walls = {&addStill(at(2, 0, 0)), &addStill(at(-2, 0, 0)), &addStill(at(0, 2, 0)), &addStill(at(0, -2, 0))};
        btSoftBody* cube = btFemHelpers::createBox(m_world.info(), btVector3(0, 0, btScalar(0.5)),
                                                   btVector3(0.5, 0.5, 0.5), btScalar(0.2));
        cube->m_cfg.kDF = 0;
        btFemMaterial material;
        material.m_youngModulus = btScalar(kYoung);
        material.m_poissonRatio = btScalar(GetParam().m_poissonRatio);
        material.m_density = btScalar(GetParam().m_density);
        material.m_stiffnessDamping = btScalar(0.05);  // to settle soon
        m_fem.setMaterial(cube, material);
        m_cube = &m_world.addSoft(cube);
        addHeavyBox();
    }

    // The box is larger than the pit, does not collide with its walls, and moves along z only.
    void addHeavyBox()
    {
        RigidSettings settings;
        settings.m_mass = btScalar(GetParam().m_mass);
        settings.m_transform = at(0, 0, btScalar(1.301));
        m_heavy = &m_world.addRigid(new btBoxShape(btVector3(btScalar(0.6), btScalar(0.6), btScalar(0.3))), settings);
        m_heavy->setLinearFactor(btVector3(0, 0, 1));
        m_heavy->setAngularFactor(0);
        for (btRigidBody* wall : m_walls) m_heavy->setIgnoreCollisionCheck(wall, true);
    }

    btRigidBody& addStill(const btTransform& transform)
    {
        RigidSettings settings;
        settings.m_transform = transform;
        settings.m_friction = 0;
        const bool wall = transform.getOrigin().z() == 0;
        return m_world.addRigid(new btBoxShape(wall ? btVector3(btScalar(1.5), btScalar(1.5), 3) : btVector3(2, 2, 1)),
                                settings);
    }

    // Mean height of the nodes with rest height z [m].
    double meanHeight(double z) const
    {
        double sum = 0;
        int count = 0;
        for (int i : m_layers[z > 0.5])
        {
            sum += m_cube->m_nodes[i].m_x.z();
            ++count;
        }
        return sum / count;
    }

    void findLayers()
    {
        for (int i = 0; i < m_cube->m_nodes.size(); ++i)
        {
            const double z = m_cube->m_nodes[i].m_x.z();
            if (z < 0.01) m_layers[0].push_back(i);
            if (z > 0.99) m_layers[1].push_back(i);
        }
    }

    static constexpr double kYoung = 1e6;  // [Pa]
    btFemSoftBodySolver m_fem;
    SoftWorld m_world{m_fem, Coupling::coupled};
    btSoftBody* m_cube = nullptr;
    btRigidBody *m_floor = nullptr, *m_heavy = nullptr;
    std::array<btRigidBody*, 4> m_walls = {};
    std::array<std::vector<int>, 2> m_layers;
};

TEST_P(Oedometer, SettlesByTheConstrainedModulusAndPressesOnTheWalls)
{
    findLayers();
    const double h = 1.0 / GetParam().m_stepsPerSecond, nu = GetParam().m_poissonRatio;
    m_world.step(4 * GetParam().m_stepsPerSecond, btScalar(h));
    // The cube's own weight shortens it as half of it on top would. Width, depth and height are 1 m.
    const double load = GetParam().m_mass * kGravity, weight = massOf(*m_cube) * kGravity;
    const double modulus = kYoung * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
    const double expected = (load + weight / 2) / modulus;
    const double shortening = 1 - (meanHeight(1) - meanHeight(0));
    EXPECT_NEAR(shortening, expected, 0.005 * expected);

    const double side = nu / (1 - nu) * (load + weight / 2);
    for (int k = 0; k < 4; ++k)
    {
        const Vec3 force = vec3(m_fem.contactForce(m_cube, m_walls[k]));
        const Vec3 inward = {k == 0 ? -1.0 : k == 1 ? 1.0 : 0.0, k == 2 ? -1.0 : k == 3 ? 1.0 : 0.0, 0};
        EXPECT_NEAR(dot(force, inward), side, 0.01 * side) << "side " << k;
        EXPECT_LT(norm(force - dot(force, inward) * inward), 1e-3 * load) << "side " << k;
    }
    EXPECT_NEAR(m_fem.contactForce(m_cube, m_floor).z(), load + weight, 1e-3 * load);
    EXPECT_NEAR(m_fem.contactForce(m_cube, m_heavy).z(), -load, 1e-3 * load);
    EXPECT_LT(norm(vec3(m_heavy->getLinearVelocity())), 1e-3);
    EXPECT_EQ(m_fem.stepReport(m_cube).m_flags, 0);
}

INSTANTIATE_TEST_SUITE_P(Contact, Oedometer,
                         testing::Values(OedometerCase{"nu10", 0.1, 1000, 5000, 60},
                                         OedometerCase{"nu30", 0.3, 1000, 5000, 60},
                                         OedometerCase{"nu45", 0.45, 1000, 5000, 60},
                                         OedometerCase{"nu30At240Hz", 0.3, 1000, 5000, 240},
                                         OedometerCase{"nu30MassRatio500", 0.3, 10, 5000, 60},
                                         OedometerCase{"nu45MassRatio800", 0.45, 10, 8000, 60}),
                         [](const auto& scene) { return scene.param.m_name; });

}  // namespace
}  // namespace bullet_fem
