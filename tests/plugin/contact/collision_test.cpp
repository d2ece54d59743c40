// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

struct CollisionCase
{
    std::string m_name;
    bool m_softBall;     // else a cube
    bool m_rigidSphere;  // else a cube
    double m_massRatio;  // rigid over soft
    bool m_offCentre;    // and spinning
};

std::vector<CollisionCase> collisionCases()
{
    std::vector<CollisionCase> cases;
    const std::pair<double, const char*> ratios[] = {
        {0.01, "1to100"}, {0.1, "1to10"}, {1, "1to1"}, {10, "10to1"}, {100, "100to1"}};
    for (const bool ball : {false, true})
        for (const bool sphere : {false, true})
            for (const bool offCentre : {false, true})
                for (const auto& [ratio, name] : ratios)
                    cases.push_back({std::string(sphere ? "sphere" : "cube") + "On" + (ball ? "Ball" : "Cube") + "_" +
                                         name + (offCentre ? "_offCentre" : ""),
                                     ball, sphere, ratio, offCentre});
    return cases;
}

class Collision : public testing::TestWithParam<CollisionCase>
{
};

// Rigid spheres and cubes only: Bullet's implicit gyroscopic term for other bodies does not conserve momentum.
TEST_P(Collision, ConservesMomentumAndEndsInSeparation)
{
    const CollisionCase& scene = GetParam();
    btFemSoftBodySolver fem;
    SoftWorld world(fem, btVector3(0, 0, 0));
    btSoftBody* made = scene.m_softBall ? btFemHelpers::createFromTetMesh(world.info(), makeSphere(0.5, 4))
                                        : btFemHelpers::createBox(world.info(), btVector3(0, 0, 0),
                                                                  btVector3(0.5, 0.5, 0.5), btScalar(0.25));
    btFemMaterial material;
    material.m_youngModulus = btScalar(2e5);
    fem.setMaterial(made, material);
    made->m_cfg.kDF = btScalar(0.5);
    btSoftBody& soft = world.addSoft(made);

    RigidSettings settings;
    settings.m_mass = btScalar(scene.m_massRatio * massOf(soft));
    settings.m_friction = 1;
    settings.m_velocity = btVector3(0, 0, -1);
    settings.m_transform = at(0, 0, btScalar(0.9));
    if (scene.m_offCentre)
    {
        settings.m_transform = at(btScalar(0.23), btScalar(-0.11), btScalar(0.9));
        settings.m_spin = btVector3(1, btScalar(-0.5), 2);
    }
    btCollisionShape* shape = scene.m_rigidSphere
                                  ? static_cast<btCollisionShape*>(new btSphereShape(btScalar(0.3)))
                                  : new btBoxShape(btVector3(btScalar(0.25), btScalar(0.25), btScalar(0.25)));
    btRigidBody& rigid = world.addRigid(shape, settings);

    Motion start = motionOf(soft);
    start += motionOf(rigid);
    const double length = 1;  // of the scene [m]
    int touchingSteps = 0, stepsSinceTouch = 0;
    for (int k = 0; k < 150; ++k)
    {
        world.step();
        const bool touching = norm(impulseOn(fem, soft)) > 0;
        touchingSteps += touching;
        stepsSinceTouch = touching ? 0 : stepsSinceTouch + 1;

        const Motion softMotion = motionOf(soft), rigidMotion = motionOf(rigid);
        Motion sum = softMotion;
        sum += rigidMotion;
        const double scale = std::max(norm(start.m_linear), norm(softMotion.m_linear) + norm(rigidMotion.m_linear));
        ASSERT_LT(norm(sum.m_linear - start.m_linear), 1e-6 * scale) << "step " << k;
        ASSERT_LT(norm(sum.m_angular - start.m_angular), 1e-5 * scale * length) << "step " << k;
        ASSERT_LT(sum.m_energy, start.m_energy * 1.0001) << "step " << k;
    }
    EXPECT_GT(touchingSteps, 0);
    EXPECT_GT(stepsSinceTouch, 10);
    const Vec3 apart = vec3(rigid.getCenterOfMassPosition()) - centerOf(soft);
    EXPECT_GT(dot(apart, vec3(rigid.getLinearVelocity()) - velocityOf(soft)), 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Collision, testing::ValuesIn(collisionCases()),
                         [](const auto& scene) { return scene.param.m_name; });

}  // namespace
}  // namespace bullet_fem
