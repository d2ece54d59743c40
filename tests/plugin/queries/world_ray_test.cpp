// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Ray tests in a world with FEM bodies.
#include <gtest/gtest.h>

#include "bullet_fem/btFemRay.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/random_rays.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

class WorldRayTest : public EachWorld
{
protected:
    btSoftBody& add(const SoftBox& box) { return addSoftBox(m_world, m_world.fem(), box); }

    FemWorld m_world{GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Worlds, WorldRayTest, eachWorld(), nameOfWorld);

// Bullet's tolerance is absolute, and enlarges triangles of 1 cm to the size of a hand.
TEST_P(WorldRayTest, IsExactForSmallTrianglesWithOurCallback)
{
    const int count = GetParam() == WorldClass::softRigid ? kRays : kRays / 10;
    SoftBox box;
    box.m_size = {0.1, 0.1, 0.1};
    box.m_cells = {8, 8, 8};
    btSoftBody& body = add(box);
    RigidSettings wall;
    wall.m_transform = at(0, 0, -2);
    btRigidBody& behind = addRigidBox(m_world, {10, 10, 1}, wall);
    m_world.step();
    Rays rays(body);
    int soft = 0;
    for (int k = 0; k < count; ++k)
    {
        btVector3 from, to;
        rays.next(from, to);
        from.setZ(btScalar(0.4));
        to.setZ(-4);
        const RayReference reference = bruteForce(body, vec3(from), vec3(to));
        btFemClosestRay ray(from, to);
        m_world.bullet().rayTest(from, to, ray);
        ASSERT_TRUE(ray.hasHit());
        if (reference.m_face >= 0 && reference.m_smallest < 1e-9) continue;
        ASSERT_EQ(ray.m_hit.m_face, reference.m_face);
        ASSERT_EQ(ray.m_collisionObject, reference.m_face >= 0 ? static_cast<btCollisionObject*>(&body) : &behind);
        ASSERT_NEAR(ray.m_closestHitFraction, std::min(reference.m_fraction, 1.9 / 4.4), 1e-5);
        soft += reference.m_face >= 0;
    }
    EXPECT_GT(soft, count / 50);
}

TEST_P(WorldRayTest, TellsBodyFaceNormalAndPlace)
{
    SoftBox box;
    box.m_center = {0, 0, 0.5};
    box.m_youngModulus = btScalar(3e4);
    btSoftBody& body = add(box);
    m_world.step(3);
    const btVector3 from(btScalar(0.1), btScalar(0.17), 4), to(btScalar(0.1), btScalar(0.17), -4);
    btCollisionWorld::ClosestRayResultCallback ray(from, to);
    m_world.bullet().rayTest(from, to, ray);
    ASSERT_EQ(ray.m_collisionObject, &body);
    const RayReference reference = bruteForce(body, vec3(from), vec3(to));
    EXPECT_NEAR(ray.m_closestHitFraction, reference.m_fraction, 1e-6);
    EXPECT_NEAR(ray.m_hitNormalWorld.z(), 1, 1e-4);
    EXPECT_NEAR(ray.m_hitPointWorld.z(), 4 - 8 * reference.m_fraction, 1e-5);
}

}  // namespace
}  // namespace bullet_fem
