// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <functional>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

/// Scenes with invalid input: nothing crashes, and no NaN reaches a body. In staggered (swap) and in monolithic
/// coupling.
class BadContactInput : public testing::TestWithParam<Coupling>
{
protected:
    btSoftBody& addCube(double lowest, btScalar cell = btScalar(0.25))
    {
        btSoftBody* cube = btFemHelpers::createBox(m_world.info(), btVector3(0, 0, btScalar(lowest + 0.25)),
                                                   btVector3(0.25, 0.25, 0.25), cell);
        m_fem.setMaterial(cube, btFemMaterial());
        return m_world.addSoft(cube);
    }

    btSoftBody& addTetrahedron(double height)
    {
        const btVector3 corners[] = {btVector3(0, 0, 0), btVector3(btScalar(0.3), 0, 0), btVector3(0, btScalar(0.3), 0),
                                     btVector3(0, 0, btScalar(0.3))};
        const int tet[] = {0, 1, 2, 3};
        btSoftBody* body = btFemHelpers::createFromTetMesh(m_world.info(), corners, 4, tet, 1);
        body->translate(btVector3(0, 0, btScalar(height)));
        m_fem.setMaterial(body, btFemMaterial());
        return m_world.addSoft(body);
    }

    btRigidBody& addBox(double z, double mass)
    {
        return m_world.addRigid(new btBoxShape(btVector3(1, 1, 1) * btScalar(0.2)),
                                {btScalar(mass), at(0, 0, btScalar(z))});
    }

    void stepAndExpectFinite(const btSoftBody& body, int steps)
    {
        for (int k = 0; k < steps; ++k)
        {
            m_world.step();
            ASSERT_TRUE(allFinite(body)) << "step " << k;
        }
    }

    // Expects a tetrahedron to come to rest on a ground at z = 0 with this margin [m].
    void expectATetrahedronToComeToRest(double margin)
    {
        btSoftBody& body = addTetrahedron(0.3);
        stepAndExpectFinite(body, 180);
        EXPECT_GT(lowestHeight(body), -1e-3);
        EXPECT_LT(lowestHeight(body), margin + 1e-3);
        m_world.deleteSoft(body);
    }

    // Calls a function within each step, before or after Bullet's part.
    void callInStep(bool before, std::function<void()> function)
    {
        s_tick = std::move(function);
        m_world.world().setInternalTickCallback([](btDynamicsWorld*, btScalar) { s_tick(); }, nullptr, before);
    }

    static std::function<void()> s_tick;
    btFemSoftBodySolver m_fem;
    SoftWorld m_world{m_fem, GetParam()};
};

std::function<void()> BadContactInput::s_tick;

TEST_P(BadContactInput, ATetrahedronFallsOnABox)
{
    m_world.addFloorBox();
    expectATetrahedronToComeToRest(0);
}

TEST_P(BadContactInput, ATetrahedronFallsOnAPlane)
{
    m_world.addPlane();
    expectATetrahedronToComeToRest(0);
}

TEST_P(BadContactInput, ATetrahedronFallsOnAMesh)
{
    btTriangleMesh mesh;
    mesh.addTriangle(btVector3(-5, -5, 0), btVector3(5, -5, 0), btVector3(0, 5, 0));
    auto* shape = new btBvhTriangleMeshShape(&mesh, true);
    shape->setMargin(btScalar(0.01));
    btRigidBody& ground = m_world.addRigid(shape);
    expectATetrahedronToComeToRest(0.01);
    m_world.deleteRigid(ground);  // before the mesh that it refers to
}

TEST_P(BadContactInput, TetrahedraFallOnEachOther)
{
    m_world.addFloorBox();
    btSoftBody& lower = addTetrahedron(0.01);
    btSoftBody& upper = addTetrahedron(0.4);
    for (int k = 0; k < 180; ++k)
    {
        m_world.step();
        ASSERT_TRUE(allFinite(lower) && allFinite(upper)) << "step " << k;
    }
    EXPECT_LT(fastestNode(upper), 5);
}

TEST_P(BadContactInput, RigidBodyInContactIsDeletedBetweenSteps)
{
    btRigidBody& floor = m_world.addFloorBox();
    btSoftBody& cube = addCube(0);
    btRigidBody& stone = addBox(0.71, 10);
    stepAndExpectFinite(cube, 60);
    ASSERT_GT(norm(impulseOn(m_fem, cube, &stone)), 0);
    m_world.deleteRigid(stone);
    stepAndExpectFinite(cube, 30);
    EXPECT_NEAR(m_fem.contactForce(&cube, &floor).z(), massOf(cube) * kGravity, 0.2 * massOf(cube) * kGravity);
    m_world.deleteRigid(floor);
    stepAndExpectFinite(cube, 30);
    EXPECT_EQ(m_fem.contacts(&cube).size(), 0);
    EXPECT_LT(velocityOf(cube).z, -0.45 * kGravity);  // half a second of free fall
}

TEST_P(BadContactInput, RigidBodyInContactIsDeletedWithinAStep)
{
    for (const bool before : {true, false})
    {
        SCOPED_TRACE(before);
        btRigidBody& floor = m_world.addFloorBox();
        btSoftBody& cube = addCube(0);
        btRigidBody* stone = &addBox(0.71, 10);
        int tick = 0;
        callInStep(before,
                   [&]
                   {
                       if (++tick == 20) m_world.deleteRigid(*stone);
                   });
        stepAndExpectFinite(cube, 60);
        m_world.deleteSoft(cube);
        m_world.deleteRigid(floor);
    }
}

TEST_P(BadContactInput, RigidBodyInContactLeavesWithinAStepAndReturns)
{
    for (const bool before : {true, false})
    {
        SCOPED_TRACE(before);
        btRigidBody& floor = m_world.addFloorBox();
        btSoftBody& cube = addCube(0);
        int tick = 0;
        callInStep(before,
                   [&]
                   {
                       ++tick;
                       if (tick == 20) m_world.world().removeRigidBody(&floor);
                       if (tick == 22) m_world.world().addRigidBody(&floor);
                   });
        stepAndExpectFinite(cube, 90);
        EXPECT_GT(lowestHeight(cube), -0.05);
        m_world.deleteSoft(cube);
        m_world.deleteRigid(floor);
    }
}

TEST_P(BadContactInput, SoftBodyInContactIsDeletedBetweenSteps)
{
    m_world.addFloorBox();
    btSoftBody& lower = addCube(0);
    btSoftBody& upper = addCube(0.51);
    stepAndExpectFinite(upper, 60);
    ASSERT_GT(norm(impulseOn(m_fem, upper, &lower)), 0);
    m_world.deleteSoft(lower);
    stepAndExpectFinite(upper, 90);
    EXPECT_NEAR(lowestHeight(upper), 0, 0.01);
}

// Bullet makes a body static when its mass is set to 0, although the body is in the world.
TEST_P(BadContactInput, RigidBodyBecomingStaticDoesNoHarm)
{
    m_world.addFloorBox();
    btSoftBody& cube = addCube(0);
    btRigidBody& stone = addBox(0.71, 10);
    stepAndExpectFinite(cube, 30);
    stone.setMassProps(0, btVector3(0, 0, 0));
    stepAndExpectFinite(cube, 60);
    EXPECT_EQ(std::isfinite(stone.getCenterOfMassPosition().z()), true);
}

TEST_P(BadContactInput, HugeOrTinyRigidMassDoesNoHarm)
{
    for (const btScalar mass : {btScalar(1e18), btScalar(1e-6)})
    {
        SCOPED_TRACE(mass);
        btRigidBody& floor = m_world.addFloorBox();
        btSoftBody& cube = addCube(0);
        btRigidBody& stone = addBox(0.71, mass);
        stepAndExpectFinite(cube, 60);
        EXPECT_TRUE(isFinite(vec3(stone.getCenterOfMassPosition())));
        EXPECT_TRUE(isFinite(vec3(stone.getLinearVelocity())));
        m_world.deleteSoft(cube);
        m_world.deleteRigid(stone);
        m_world.deleteRigid(floor);
    }
}

// Bullet's gyroscopic term overflows and makes the rigid body's spin NaN, with or without contacts.
TEST_P(BadContactInput, ARigidBodyOfNearlyInfiniteMassDoesNotReachTheSoftBody)
{
    m_world.addFloorBox();
    btSoftBody& cube = addCube(0);
    addBox(0.71, 1e30);
    stepAndExpectFinite(cube, 120);
}

TEST_P(BadContactInput, NonFiniteMassDoesNotReachTheSoftBody)
{
    m_world.addFloorBox();
    btSoftBody& cube = addCube(0);
    btRigidBody& stone = addBox(0.71, 10);
    stepAndExpectFinite(cube, 30);
    stone.setMassProps(btScalar(NAN), btVector3(NAN, NAN, NAN));
    stepAndExpectFinite(cube, 30);
}

TEST_P(BadContactInput, EmptyCompoundHasNoContact)
{
    m_world.addFloorBox();
    m_world.addRigid(new btCompoundShape);
    btSoftBody& cube = addCube(0.01);
    stepAndExpectFinite(cube, 60);
    EXPECT_NEAR(lowestHeight(cube), 0, 1e-3);
}

TEST_P(BadContactInput, AnEmptyOrFlatHullDoesNoHarm)
{
    m_world.addFloorBox();
    m_world.addRigid(new btConvexHullShape);
    auto* point = new btConvexHullShape;
    point->addPoint(btVector3(0, 0, btScalar(0.1)));
    m_world.addRigid(point);
    auto* flat = new btConvexHullShape;
    for (const btScalar x : {-1, 1})
        for (const btScalar y : {-1, 1}) flat->addPoint(btVector3(x, y, 0));
    m_world.addRigid(flat);
    btSoftBody& cube = addCube(0.3);
    stepAndExpectFinite(cube, 120);
    EXPECT_LT(fastestNode(cube), 5);
}

TEST_P(BadContactInput, AShapeWithoutSizeDoesNoHarm)
{
    m_world.addFloorBox();
    m_world.addRigid(new btSphereShape(0));
    m_world.addRigid(new btBoxShape(btVector3(0, 0, 0)));
    m_world.addRigid(new btCapsuleShape(0, 0));
    btSoftBody& cube = addCube(0.1);
    stepAndExpectFinite(cube, 120);
    EXPECT_LT(fastestNode(cube), 5);
}

TEST_P(BadContactInput, AMarginLargerThanElementsIsAThickerShape)
{
    RigidSettings settings;
    settings.m_transform = at(0, 0, -1);
    auto* hull = new btConvexHullShape;
    for (const btScalar x : {-2, 2})
        for (const btScalar y : {-2, 2})
            for (const btScalar z : {-1, 1}) hull->addPoint(btVector3(x, y, z));
    hull->setMargin(btScalar(0.3));
    m_world.addRigid(hull, settings);
    btSoftBody& cube = addCube(0.32, btScalar(0.125));
    cube.getCollisionShape()->setMargin(btScalar(0.5));  // ignored
    stepAndExpectFinite(cube, 180);
    EXPECT_NEAR(lowestHeight(cube), 0.3, 1e-3);
}

TEST_P(BadContactInput, FrictionAndRestitutionOutOfTheirRangesDoNoHarm)
{
    btRigidBody& floor = m_world.addFloorBox();
    btSoftBody& cube = addCube(0.05);
    for (const btScalar value : {btScalar(-1), btScalar(NAN), btScalar(1e30), btScalar(INFINITY)})
    {
        SCOPED_TRACE(value);
        floor.setFriction(value);
        floor.setRestitution(value);
        cube.setRestitution(value);
        floor.setContactStiffnessAndDamping(value, value);
        cube.translate(btVector3(0, 0, btScalar(0.02)));
        stepAndExpectFinite(cube, 30);
    }
}

INSTANTIATE_TEST_SUITE_P(Contact, BadContactInput, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

}  // namespace
}  // namespace bullet_fem
