// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

constexpr double kLength = 1;  // of the scene [m]

struct MomentumCase
{
    Coupling m_coupling;
    int m_power;       // log10 of rigid mass over soft mass
    bool m_softFlies;  // the soft body flies, else the rigid one
    bool m_sphere;     // else a cube
    bool m_offCentre;  // and the flying body spins
};

std::string nameOf(const testing::TestParamInfo<MomentumCase>& info)
{
    const MomentumCase& scene = info.param;
    const std::string ratio = std::to_string(static_cast<int>(std::pow(10, std::abs(scene.m_power))));
    return std::string(couplingName(scene.m_coupling)) + "_" + (scene.m_power < 0 ? "1to" + ratio : ratio + "to1") +
           (scene.m_softFlies ? "_softOn" : "_by") + (scene.m_sphere ? "Sphere" : "Cube") +
           (scene.m_offCentre ? "_offCentre" : "");
}

std::vector<MomentumCase> momentumCases()
{
    std::vector<MomentumCase> cases;
    for (const Coupling coupling : {Coupling::swap, Coupling::coupled})
        for (int power = -3; power <= 3; ++power)
            for (const bool softFlies : {false, true})
                for (const bool sphere : {false, true})
                    for (const bool offCentre : {false, true})
                        cases.push_back({coupling, power, softFlies, sphere, offCentre});
    return cases;
}

class ZeroGravity : public testing::TestWithParam<MomentumCase>
{
protected:
    ZeroGravity() : m_world(m_fem, GetParam().m_coupling, btVector3(0, 0, 0))
    {
        const MomentumCase& scene = GetParam();
        SoftBox cube;
        cube.m_cells = {4, 4, 4};
        cube.m_youngModulus = btScalar(2e5);
        m_soft = &addSoftBox(m_world, m_fem, cube);
        RigidSettings settings;
        settings.m_mass = static_cast<btScalar>(std::pow(10, scene.m_power) * massOf(*m_soft));
        settings.m_transform = at(0, 0, btScalar(0.85));
        if (scene.m_offCentre)
        {
            settings.m_transform = at(btScalar(0.23), btScalar(-0.11), btScalar(0.85));
        }
        const btVector3 spin = scene.m_offCentre ? btVector3(1, btScalar(-0.5), 2) : btVector3(0, 0, 0);
        if (scene.m_softFlies)
            for (int i = 0; i < m_soft->m_nodes.size(); ++i)
                m_soft->m_nodes[i].m_v = btVector3(0, 0, 1) + spin.cross(m_soft->m_nodes[i].m_x);
        else
        {
            settings.m_velocity = btVector3(0, 0, -1);
            settings.m_spin = spin;
        }
        m_rigid = scene.m_sphere ? &m_world.addRigid(new btSphereShape(btScalar(0.3)), settings)
                                 : &addRigidBox(m_world, {0.6, 0.6, 0.6}, settings);
        if (!scene.m_sphere) m_rigid->setFriction(btScalar(0.6));
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btSoftBody* m_soft;
    btRigidBody* m_rigid;
};

// Both couplings. Rigid spheres and cubes only: Bullet's implicit gyroscopic term for other bodies does not conserve
// momentum.
TEST_P(ZeroGravity, CollisionsKeepBothMomenta)
{
    Motion start = motionOf(*m_soft);
    start += motionOf(*m_rigid);
    int touchingSteps = 0;
    double linear = 0, angular = 0;  // maximum relative errors
    for (int k = 0; k < 90; ++k)
    {
        m_world.step();
        touchingSteps += norm(impulseOn(m_fem, *m_soft)) > 0;
        const Motion soft = motionOf(*m_soft), rigid = motionOf(*m_rigid);
        Motion sum = soft;
        sum += rigid;
        const double scale = std::max(norm(start.m_linear), norm(soft.m_linear) + norm(rigid.m_linear));
        linear = std::max(linear, norm(sum.m_linear - start.m_linear) / scale);
        angular = std::max(angular, norm(sum.m_angular - start.m_angular) / (scale * kLength));
        ASSERT_LT(sum.m_energy, start.m_energy * 1.0001) << "step " << k;
    }
    EXPECT_LT(linear, 1e-6);
    EXPECT_LT(angular, 1e-5);
    EXPECT_GT(touchingSteps, 0);
    const Vec3 apart = vec3(m_rigid->getCenterOfMassPosition()) - centerOf(*m_soft);
    EXPECT_GT(dot(apart, vec3(m_rigid->getLinearVelocity()) - velocityOf(*m_soft)), 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ZeroGravity, testing::ValuesIn(momentumCases()), nameOf);

}  // namespace
}  // namespace bullet_fem
