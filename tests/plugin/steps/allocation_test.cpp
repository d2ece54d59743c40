// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Steps of a world allocate nothing. A separate program: the counter replaces malloc.
#include <gtest/gtest.h>

#include "BulletDynamics/Featherstone/btMultiBodyJointMotor.h"
#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemFracture.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/link_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/skin_bodies.h"
#include "plugin/scenes/soft_boxes.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

/// Counts allocations inside the solver's virtual functions; Bullet's own allocations around them are excluded.
class CountingSolver : public btFemSoftBodySolver
{
public:
    using btFemSoftBodySolver::btFemSoftBodySolver;

    void optimize(btAlignedObjectArray<btSoftBody*>& bodies, bool forceUpdate = false) override
    {
        const AllocationCounter counter;
        btFemSoftBodySolver::optimize(bodies, forceUpdate);
        m_allocations += counter.count();
    }
    void predictMotion(btScalar timeStep) override
    {
        const AllocationCounter counter;
        btFemSoftBodySolver::predictMotion(timeStep);
        m_allocations += counter.count();
    }
    void processCollision(btSoftBody* body, const btCollisionObjectWrapper* other) override
    {
        const AllocationCounter counter;
        btFemSoftBodySolver::processCollision(body, other);
        m_allocations += counter.count();
    }
    void processCollision(btSoftBody* body, btSoftBody* other) override
    {
        const AllocationCounter counter;
        btFemSoftBodySolver::processCollision(body, other);
        m_allocations += counter.count();
    }
    void solveConstraints(btScalar timeStep) override
    {
        const AllocationCounter counter;
        btFemSoftBodySolver::solveConstraints(timeStep);
        m_allocations += counter.count();
    }
    void updateSoftBodies() override
    {
        const AllocationCounter counter;
        btFemSoftBodySolver::updateSoftBodies();
        m_allocations += counter.count();
    }

    long m_allocations = 0;
};

// Steps without growth of the number of contacts must not allocate; the first two may. Returns the number of checked
// steps.
template <class World>
int expectNoAllocations(CountingSolver& fem, World& world, const std::vector<btSoftBody*>& bodies, int steps)
{
    std::vector<int> mostContacts(bodies.size(), 0);
    int checked = 0;
    for (int k = 0; k < steps; ++k)
    {
        fem.m_allocations = 0;
        world.step();
        bool grown = k < 2;
        for (std::size_t b = 0; b < bodies.size(); ++b)
        {
            const int contacts = fem.contacts(bodies[b]).size();
            grown = grown || contacts > mostContacts[b];
            mostContacts[b] = std::max(mostContacts[b], contacts);
        }
        if (grown) continue;
        ++checked;
        EXPECT_EQ(fem.m_allocations, 0) << "step " << k;
    }
    return checked;
}

TEST(Allocations, OccurInTheFirstStep)
{
    CountingSolver fem;
    SoftWorld world(fem);
    addUnitCube(world, btVector3(0, 0, 0));
    world.step();
    EXPECT_GT(fem.m_allocations, 100);  // checks that allocations are counted
}

TEST(Allocations, AreNoneForABodyInFlight)
{
    CountingSolver fem;
    SoftWorld world(fem);
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, 0));
    cube.setMass(0, 0);
    EXPECT_EQ(expectNoAllocations(fem, world, {&cube}, 60), 58);
}

// The bar hangs from one face, with a tension near its strength.
TEST(Allocations, AreNoneForAnUnsplitBody)
{
    CountingSolver fem;
    SoftWorld world(fem);
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, 0));
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (double(cube.m_nodes[i].m_x.z()) > 0.49) cube.setMass(i, 0);
    fem.prepare(&cube, kStep);
    btFemTensileStrength strength;
    strength.m_tension = btScalar(3e4);
    btFemFracture::setStrength(fem, &cube, strength);
    EXPECT_EQ(expectNoAllocations(fem, world, {&cube}, 60), 58);
    EXPECT_EQ(btFemFracture::splits(fem).size(), 0);
}

TEST(Allocations, AreNoneForASpringDraggedBody)
{
    CountingSolver fem;
    SoftWorld world(fem);
    world.addFloorBox();
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, btScalar(0.5)));
    fem.prepare(&cube, kStep);
    btFemSpring spring;
    spring.m_nodes[0] = cube.m_nodes.size() - 1;
    spring.m_target = cube.m_nodes[spring.m_nodes[0]].m_x + btVector3(btScalar(0.5), 0, 0);
    spring.m_stiffness = btScalar(2e4);
    fem.addSpring(&cube, spring);
    EXPECT_GT(expectNoAllocations(fem, world, {&cube}, 90), 40);
    EXPECT_GT(cube.m_rcontacts.size(), 0);
}

// Their contacts are thinned: the number found may grow although the number kept does not, so the bodies make the
// motion beforehand.
TEST(Allocations, AreNoneForCollidingRenderSurfaces)
{
    CountingSolver fem;
    SoftWorld world(fem);
    world.addFloorBox();
    btSoftBody& box = addSkinBody(world, fem, skinBox({0.8, 0.8, 0.2}, {0, 0, 0.101}));
    btSoftBody& ball = addSkinBody(world, fem, skinBall({0, 0, 0.72}));
    box.m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
    world.step(60);
    ball.setVelocity(btVector3(0, 0, btScalar(0.3)));
    world.step(60);
    ball.setVelocity(btVector3(0, 0, btScalar(0.2)));
    EXPECT_GT(expectNoAllocations(fem, world, {&box, &ball}, 30), 10);
    EXPECT_GT(fem.contacts(&ball).size(), 0);
}

// The contacts of its nodes and faces vary. Bullet itself allocates for cloth, equally in each step.
TEST(Allocations, AreOnlyBulletsOwnForClothOnABall)
{
    const auto run = [](bool touches)
    {
        CountingSolver fem;
        SoftWorld world(fem);
        btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), makeSphere(0.3, 4));
        for (int i = 0; i < ball->m_nodes.size(); ++i)
            if (ball->m_nodes[i].m_x.z() < btScalar(-0.2)) ball->setMass(i, 0);
        const btScalar a = btScalar(0.4);
        btSoftBody* cloth = btSoftBodyHelpers::CreatePatch(world.info(), btVector3(-a, -a, a), btVector3(a, -a, a),
                                                           btVector3(-a, a, a), btVector3(a, a, a), 9, 9, 0, true);
        cloth->getCollisionShape()->setMargin(btScalar(0.02));
        cloth->setTotalMass(btScalar(0.3));
        for (btSoftBody* body : {ball, cloth})
            if (touches) body->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        world.addSoft(ball);
        world.addSoft(cloth);
        world.step(120);
        long most = 0;
        for (int k = 0; k < 60; ++k)
        {
            fem.m_allocations = 0;
            world.step();
            most = std::max(most, fem.m_allocations);
        }
        EXPECT_EQ(fem.contacts(ball).size() > 20, touches);
        return most;
    };
    EXPECT_LE(run(true), run(false));
}

// Varying interest moves it through all levels; the account of a stale factor is active.
TEST(Allocations, AreNoneWithChangingDetailAndAStaleFactor)
{
    CountingSolver fem;
    SoftWorld world(fem);
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, 0));
    btFemViewerInterest viewer(1, 50);
    viewer.setVisibility([](const btSoftBody&) { return true; });
    btFemDetailPolicy policy;
    policy.m_dwell = 0;
    fem.setInterest(&viewer, policy);
    fem.prepare(&cube, kStep / 2);
    int low = 0;
    for (int k = 0; k < 60; ++k)
    {
        viewer.setViewer(btVector3(btScalar(k % 30) * 2, 0, 0));
        fem.m_allocations = 0;
        world.step();
        EXPECT_EQ(k < 2 ? 0 : fem.m_allocations, 0) << "step " << k;
        EXPECT_TRUE(fem.stepReport(&cube).m_flags & BT_FEM_STALE_FACTOR);
        low += fem.stepReport(&cube).m_detail != btFemDetail::nodalWarp;
    }
    EXPECT_GT(low, 10);
    EXPECT_LT(low, 50);
}

TEST(Allocations, AreNoneForACubeAtRestOnABox)
{
    CountingSolver fem;
    SoftWorld world(fem);
    world.addFloorBox();
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, btScalar(0.501)));
    EXPECT_GT(expectNoAllocations(fem, world, {&cube}, 120), 110);
    EXPECT_GT(fem.contacts(&cube).size(), 0);
}

TEST(Allocations, AreNoneForASleepingBody)
{
    CountingSolver fem;
    SoftWorld world(fem);
    auto* floor = new btCompoundShape;
    for (const btScalar x : {btScalar(-0.5), btScalar(0.5), btScalar(9)})
        floor->addChildShape(at(x, 0, 0), world.keep(new btBoxShape(btVector3(btScalar(0.5), 2, 1))));
    world.addRigid(floor, {0, at(0, 0, -1)}).forceActivationState(ISLAND_SLEEPING);
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, btScalar(0.501)));
    cube.forceActivationState(ACTIVE_TAG);
    world.step(300);
    ASSERT_EQ(cube.getActivationState(), ISLAND_SLEEPING);
    EXPECT_EQ(expectNoAllocations(fem, world, {&cube}, 30), 28);
}

TEST(Allocations, AreNoneForASlidingCube)
{
    CountingSolver fem;
    SoftWorld world(fem);
    const btQuaternion tilt(btVector3(0, 1, 0), btScalar(0.5));
    RigidSettings settings;
    settings.m_transform = btTransform(tilt, quatRotate(tilt, btVector3(0, 0, -1)));
    world.addRigid(new btBoxShape(btVector3(30, 30, 1)), settings);
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, btScalar(0.5)));
    cube.rotate(tilt);
    cube.m_cfg.kDF = btScalar(0.3);
    EXPECT_GT(expectNoAllocations(fem, world, {&cube}, 120), 100);
    EXPECT_GT(norm(velocityOf(cube)), 1);
}

TEST(Allocations, AreNoneForSeveralBodiesAndARigidOneOnTop)
{
    CountingSolver fem;
    SoftWorld world(fem);
    world.addPlane();
    btSoftBody& first = addUnitCube(world, btVector3(0, 0, btScalar(0.501)));
    btSoftBody& second = addUnitCube(world, btVector3(3, 0, btScalar(0.501)));
    addRigidBox(world, {0.4, 0.4, 0.4}, {50, at(0, 0, btScalar(1.21))});
    EXPECT_GT(expectNoAllocations(fem, world, {&first, &second}, 120), 60);
}

TEST(Allocations, AreNoneForBatchedCopies)
{
    CountingSolver fem;
    SoftWorld world(fem);
    std::vector<btSoftBody*> cubes;
    for (int k = 0; k < 6; ++k)
    {
        cubes.push_back(&addUnitCube(world, btVector3(btScalar(10 * k), 0, 0)));
        cubes.back()->m_nodes[0].m_v.setX(btScalar(0.5 * k));
    }
    EXPECT_EQ(expectNoAllocations(fem, world, cubes, 60), 58);
}

TEST(Allocations, AreNoneForHeldBodies)
{
    CountingSolver fem;
    SoftWorld world(fem);
    btSoftBody &upper = addUnitCube(world, btVector3(0, 0, 0)),
               &lower = addUnitCube(world, btVector3(0, 0, btScalar(-1.2)));
    btRigidBody& ceiling = world.addRigid(new btSphereShape(btScalar(0.1)), {0, at(0, 0, 2)});
    upper.appendAnchor(0, &ceiling);
    upper.appendDeformableAnchor(1, &ceiling);
    upper.m_collisionDisabledObjects.push_back(&lower);
    upper.generateClusters(1);
    lower.generateClusters(1);
    btSoftBody::LJoint::Specs joint;
    joint.position = btVector3(0, 0, btScalar(-0.6));
    lower.appendLinearJoint(joint, &upper);
    fem.prepare(&upper, kStep);
    fem.prepare(&lower, kStep);
    fem.attachNodes(&upper, 2, &lower, 3);
    EXPECT_GT(expectNoAllocations(fem, world, {&upper, &lower}, 60), 40);
    EXPECT_EQ(fem.anchors(&upper).size(), 4);
}

// A recurring step reuses its old factor: only the first change allocates for factoring.
TEST(Allocations, OccurOnceForRecurringSteps)
{
    CountingSolver fem;
    SoftWorld world(fem);
    world.addFloorBox();
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, btScalar(0.501)));
    world.step(30);
    fem.m_allocations = 0;
    world.step(1, kStep / 2);
    ASSERT_TRUE(fem.stepReport(&cube).m_flags & BT_FEM_REFACTORED);
    const long factored = fem.m_allocations;
    for (int k = 0; k < 40; ++k)
    {
        fem.m_allocations = 0;
        world.step(1, k % 2 == 0 ? kStep : kStep / 2);
        ASSERT_TRUE(fem.stepReport(&cube).m_flags & BT_FEM_REFACTORED) << "step " << k;
        EXPECT_LT(fem.m_allocations, factored / 4) << "step " << k;
    }
}

TEST(Allocations, AreNoneForLastingManifolds)
{
    btFemSolverInfo info;
    info.m_manifolds = true;
    CountingSolver fem(info);
    SoftWorld world(fem);
    world.addFloorBox();
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, btScalar(0.501)));
    EXPECT_GT(expectNoAllocations(fem, world, {&cube}, 120), 110);
    EXPECT_EQ(world.world().getDispatcher()->getNumManifolds(), 1);
}

TEST(Allocations, AreNoneForStressesOnceGrown)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, 1));
    btAlignedObjectArray<btFemStress> perElement, perNode;
    btAlignedObjectArray<btScalar> vonMises;
    for (int k = 0; k < 2; ++k)
    {
        world.step();
        const AllocationCounter counter;
        ASSERT_TRUE(fem.getStress(&cube, perElement));
        ASSERT_TRUE(fem.getNodeStress(&cube, perNode));
        ASSERT_TRUE(fem.getVonMises(&cube, vonMises));
        EXPECT_EQ(counter.count() > 0, k == 0);
    }
}

// It is anchored to a link, and rests on another one of that multibody.
TEST(Allocations, AreNoneForMultibodyLinks)
{
    CountingSolver fem;
    MultiBodyWorld world(fem);
    const btVector3 half(1, 1, btScalar(0.1)), inertia(1, 1, 1);
    auto* body = new btMultiBody(1, 50, inertia, true, false);
    body->setupRevolute(0, 50, inertia, -1, btQuaternion::getIdentity(), btVector3(0, 1, 0), btVector3(-1, 0, 0),
                        btVector3(1, 0, 0));
    world.addMultiBody(body);
    btMultiBodyLinkCollider& link = world.addCollider(*body, 0, new btBoxShape(half));
    btSoftBody& cube = world.addSoft(btFemHelpers::createBox(world.info(), btVector3(0, 0, btScalar(0.6)),
                                                             btVector3(0.5, 0.5, 0.5), btScalar(0.25)));
    cube.appendDeformableAnchor(0, &link);
    world.step(60);  // until each kind of event has happened
    EXPECT_GT(expectNoAllocations(fem, world, {&cube}, 60), 30);
    EXPECT_GT(fem.touches(&cube).size(), 0);
}

/// Counts allocations from the free motion to the end of the solve of islands with FEM bodies.
class CountingLinkSolver : public btFemMultiBodyConstraintSolver
{
public:
    using btFemMultiBodyConstraintSolver::btFemMultiBodyConstraintSolver;

    void solveMultiBodyGroup(btCollisionObject** bodies, int numBodies, btPersistentManifold** manifolds,
                             int numManifolds, btTypedConstraint** constraints, int numConstraints,
                             btMultiBodyConstraint** multiBodyConstraints, int numMultiBodyConstraints,
                             const btContactSolverInfo& info, btIDebugDraw* debugDrawer,
                             btDispatcher* dispatcher) override
    {
        const AllocationCounter counter;
        btFemMultiBodyConstraintSolver::solveMultiBodyGroup(bodies, numBodies, manifolds, numManifolds, constraints,
                                                            numConstraints, multiBodyConstraints,
                                                            numMultiBodyConstraints, info, debugDrawer, dispatcher);
        m_allocations += counter.count();
    }

    static long m_allocations;
};

long CountingLinkSolver::m_allocations = 0;

// A motor, a contact between links and one with a rigid body are rows of the contact problem.
TEST(Allocations, AreNoneForRowsOfMultibodies)
{
    btFemSoftBodySolver fem;
    LinkWorld<btSoftMultiBodyDynamicsWorld, CountingLinkSolver, btFemSoftBodySolver> world(fem);
    const btVector3 half(1, 1, btScalar(0.1)), inertia(1, 1, 1), up(0, 0, 1), none(0, 0, 0);
    const btQuaternion noTurn = btQuaternion::getIdentity();
    auto* body = new btMultiBody(2, 0, none, true, false);
    body->setupPrismatic(0, 50, inertia, -1, noTurn, up, none, none, false);
    body->setupPrismatic(1, 50, inertia, -1, noTurn, up, btVector3(0, 0, btScalar(0.2)), none, false);
    body->setHasSelfCollision(true);
    world.addMultiBody(body);
    for (const int link : {0, 1}) world.addCollider(*body, link, new btBoxShape(half));
    world.addConstraint<btMultiBodyJointMotor>(body, 0, btScalar(0), btScalar(1e4));
    btSoftBody& cube = world.addSoft(btFemHelpers::createBox(world.info(), btVector3(0, 0, btScalar(0.8)),
                                                             btVector3(0.5, 0.5, 0.5), btScalar(0.25)));
    RigidSettings settings;
    settings.m_mass = 10;
    settings.m_transform = at(btScalar(0.7), 0, btScalar(0.4));
    world.addRigid(new btBoxShape(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1))), settings);
    world.step(60);                                   // until each kind of event has happened
    EXPECT_GT(CountingLinkSolver::m_allocations, 0);  // checks that allocations are counted
    EXPECT_GT(fem.touches(&cube).size(), 0);
    CountingLinkSolver::m_allocations = 0;
    world.step(30);
    EXPECT_EQ(CountingLinkSolver::m_allocations, 0);
}

TEST(Allocations, AreNoneForRepeatedReactionQueries)
{
    CountingSolver fem;
    SoftWorld world(fem);
    SoftBox box;
    box.m_youngModulus = btScalar(2e5);
    btSoftBody& cube = *makeSoftBox(world, fem, box);
    clampBelow(cube, -0.4);
    world.addSoft(&cube);
    EXPECT_EQ(18, expectNoAllocations(fem, world, {&cube}, 20));
    btAlignedObjectArray<btVector3> forces;
    ASSERT_TRUE(fem.getReactionForces(&cube, forces));
    world.step();
    const AllocationCounter counter;
    EXPECT_TRUE(fem.getReactionForces(&cube, forces));
    EXPECT_EQ(25, fem.reaction(&cube, {0, 0, 0}).m_count);
    EXPECT_EQ(0, counter.count());
}

}  // namespace
}  // namespace bullet_fem
