// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <new>

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

btSoftBody* makeCube(SoftWorld& world, const btVector3& center = {0, 0, 0}, btScalar cell = btScalar(0.25))
{
    return btFemHelpers::createBox(world.info(), center, btVector3(0.5, 0.5, 0.5), cell);
}

class Lifecycle : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, Lifecycle, eachWorld(), nameOfWorld);

// A btFemDeformableBodySolver serves one world.
class LifecycleOfWorlds : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, LifecycleOfWorlds, testing::Values(WorldClass::softRigid, WorldClass::softMultiBody),
                         nameOfWorld);

TEST_P(Lifecycle, BodiesComeAndGoAtAnyTime)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    world.addPlane();
    btSoftBody& first = world.addSoft(makeCube(world, btVector3(0, 0, btScalar(0.55))));
    world.step(30);
    btSoftBody& second = world.addSoft(makeCube(world, btVector3(3, 0, btScalar(0.55))));
    world.step(60);
    EXPECT_TRUE(fem.isFem(&first));
    EXPECT_TRUE(fem.isFem(&second));
    world.deleteSoft(first);
    world.step(1);
    EXPECT_FALSE(fem.isFem(&first));
    EXPECT_EQ(fem.contacts(&first).size(), 0);
    EXPECT_EQ(fem.stepReport(&first).m_nodes, 0);
    world.step(60);
    EXPECT_NEAR(impulseOn(fem, second).z / kStep, massOf(second) * kGravity, 0.01 * massOf(second) * kGravity);
    for (int k = 0; k < 10; ++k)
    {
        btSoftBody& brief = world.addSoft(makeCube(world, btVector3(-3, 0, 2), btScalar(0.5)));
        world.step(k % 3);
        world.deleteSoft(brief);
    }
    world.step(10);
    EXPECT_TRUE(allFinite(second));
}

// Makes a body with the elements of `pattern` and its positions times `stretch` in one of two fixed buffers, so that
// addresses are reused for certain.
btSoftBody* makeInPlace(SoftWorld& world, const btSoftBody& pattern, btScalar stretch, int place = 0)
{
    alignas(btSoftBody) static unsigned char places[2][sizeof(btSoftBody)];
    btAlignedObjectArray<btVector3> x;
    for (int i = 0; i < pattern.m_nodes.size(); ++i) x.push_back(stretch * pattern.m_nodes[i].m_x);
    auto* body = ::new (static_cast<void*>(places[place])) btSoftBody(&world.info(), x.size(), &x[0], nullptr);
    for (int e = 0; e < pattern.m_tetras.size(); ++e)
    {
        int node[4];
        for (int a = 0; a < 4; ++a) node[a] = static_cast<int>(pattern.m_tetras[e].m_n[a] - &pattern.m_nodes[0]);
        body->appendTetra(node[0], node[1], node[2], node[3]);
    }
    world.put(*body);
    return body;
}

void stepAndRemoveAtRest(SoftWorld& world, const btFemSoftBodySolver& fem, btSoftBody* body)
{
    const std::vector<Vec3> shape = edgesOf(*body);
    world.step(30);
    EXPECT_TRUE(fem.isFem(body));
    EXPECT_EQ(fem.stepReport(body).m_flags, 0);
    EXPECT_LT(largestDifference(shape, edgesOf(*body)), 1e-4);  // at rest: this is its rest shape
    world.take(*body);
    body->~btSoftBody();
}

TEST_P(Lifecycle, BodyAtAReusedAddressIsRecognizedAsNew)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btFemSoftBodySolver& fem = world.fem();
    const std::unique_ptr<btSoftBody> pattern(makeCube(world));
    for (const btScalar stretch : {btScalar(1), btScalar(1.2)})
        stepAndRemoveAtRest(world, fem, makeInPlace(world, *pattern, stretch));
}

// The order of bodies affects rounding.
TEST_P(Lifecycle, BodyAtAReusedAddressComesLast)
{
    std::vector<btScalar> bits[2];
    for (int place = 0; place < 2; ++place)
    {
        FemWorld world(GetParam());
        world.addPlane();
        const std::unique_ptr<btSoftBody> below(makeCube(world, btVector3(0, 0, btScalar(0.51))));
        const std::unique_ptr<btSoftBody> above(makeCube(world, btVector3(btScalar(0.4), 0, btScalar(1.52))));
        btSoftBody* brief = makeInPlace(world, *below, 1);
        const btSoftBody& left = world.addSoft(makeCube(world, btVector3(btScalar(-0.2), 0, btScalar(0.51))));
        const btSoftBody& right = world.addSoft(makeCube(world, btVector3(btScalar(0.9), 0, btScalar(0.51))));
        world.step();
        world.take(*brief);
        brief->~btSoftBody();
        btSoftBody* late = makeInPlace(world, *above, 1, place);
        world.step(30);
        const btSoftBody* const bodies[] = {&left, &right, late};
        for (const btSoftBody* body : bodies)
            for (const btScalar value : bitsOf(*body)) bits[place].push_back(value);
        world.take(*late);
        late->~btSoftBody();
    }
    EXPECT_TRUE(bits[0] == bits[1]);
}

TEST_P(Lifecycle, ReusedAddressHasNoStaleReports)
{
    FemWorld world(GetParam());
    const btFemSoftBodySolver& fem = world.fem();
    world.addPlane();
    const std::unique_ptr<btSoftBody> below(makeCube(world, btVector3(0, 0, btScalar(0.51))));
    btSoftBody* brief = makeInPlace(world, *below, 1);
    world.step(30);
    ASSERT_GT(fem.contacts(brief).size(), 0);
    world.take(*brief);
    brief->~btSoftBody();
    btSoftBody* late = makeInPlace(world, *below, 1);
    ASSERT_EQ(late, brief);
    EXPECT_FALSE(fem.isFem(late));
    EXPECT_EQ(fem.contacts(late).size(), 0);
    EXPECT_EQ(fem.stepReport(late).m_nodes, 0);
    world.take(*late);
    late->~btSoftBody();
}

// The next world reuses broadphase ids, and possibly the address of the last world.
TEST_P(LifecycleOfWorlds, BodyAtAReusedAddressInTheNextWorldIsNew)
{
    btFemSoftBodySolver fem;
    SoftWorld home(GetParam(), fem, btVector3(0, 0, 0));
    const std::unique_ptr<btSoftBody> pattern(makeCube(home));
    for (const btScalar stretch : {btScalar(1), btScalar(1.2), btScalar(0.9)})
    {
        SoftWorld world(GetParam(), fem, btVector3(0, 0, 0));
        stepAndRemoveAtRest(world, fem, makeInPlace(world, *pattern, stretch));
    }
}

TEST_P(Lifecycle, ABodyTakenOutAndPutBackKeepsItsRestShapeAndMaterial)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btSoftBody& cube = world.addSoft(makeCube(world));
    const std::vector<Vec3> rest = edgesOf(cube);
    for (int i = 0; i < cube.m_nodes.size(); ++i) cube.m_nodes[i].m_v.setX(10 * cube.m_nodes[i].m_x.x());
    world.step(3);
    ASSERT_GT(largestDifference(rest, edgesOf(cube)), 0.005);
    world.take(cube);
    world.put(cube);  // no step in between
    world.step(300);
    EXPECT_LT(largestDifference(rest, edgesOf(cube)), 1e-3);
}

TEST_P(Lifecycle, ABodyAddedTwiceIsSteppedOnceAndFlagged)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& cube = world.addSoft(makeCube(world));
    world.softBodies().push_back(&cube);
    world.step(30);
    EXPECT_TRUE(fem.stepReport(&cube).m_flags & BT_FEM_ADDED_TWICE);
    EXPECT_NEAR(velocityOf(cube).z, -kGravity * 30 * kStep, 1e-4);
    world.softBodies().pop_back();
    world.step();
    EXPECT_EQ(fem.stepReport(&cube).m_flags, 0);
}

// Counts a body's proxies in a broad phase.
struct ProxyCount : btBroadphaseAabbCallback
{
    explicit ProxyCount(const btSoftBody& body) : m_body(body) {}
    bool process(const btBroadphaseProxy* proxy) override
    {
        m_count += proxy->m_clientObject == &m_body;
        return true;
    }
    const btSoftBody& m_body;
    int m_count = 0;
};

int proxiesOf(SoftWorld& world, const btSoftBody& body)
{
    ProxyCount count(body);
    const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
    world.bullet().getBroadphase()->aabbTest(-far, far, count);
    return count.m_count;
}

// Bullet gives a body that is added twice two proxies; after one removal it is still in the world, without any, and the
// solver adds one.
TEST_P(Lifecycle, ABodyAddedTwiceAndRemovedOnceStays)
{
    for (const int stepsBetween : {0, 1, 5})
    {
        FemWorld world(GetParam());
        world.addPlane();
        btSoftBody& cube = world.addSoft(makeCube(world, btVector3(0, 0, btScalar(0.5))));
        world.put(cube);
        world.step(stepsBetween);
        world.take(cube);
        world.step(60);
        EXPECT_EQ(world.fem().stepReport(&cube).m_flags, 0);
        EXPECT_EQ(proxiesOf(world, cube), 1) << stepsBetween;
        const double weight = massOf(cube) * kGravity;
        // In a deformable world forces apply to added bodies, and are removed with them.
        if (GetParam() != WorldClass::deformable)
        {
            EXPECT_NEAR(impulseOn(world.fem(), cube).z / kStep, weight, 0.01 * weight);
        }
        world.deleteSoft(cube);
        world.step(5);
    }
}

TEST_P(LifecycleOfWorlds, ABodyInTwoWorldsOfOneSolverIsSteppedByOne)
{
    btFemSoftBodySolver fem;
    SoftWorld one(GetParam(), fem), other(GetParam(), fem);
    btSoftBody& cube = one.addSoft(makeCube(one));
    one.step(2);
    other.softBodies().push_back(&cube);
    for (int k = 0; k < 10; ++k)
    {
        other.step();
        one.step();
    }
    EXPECT_TRUE(fem.stepReport(&cube).m_flags & BT_FEM_OTHER_WORLD);
    EXPECT_NEAR(velocityOf(cube).z, -kGravity * 12 * kStep, 2.01 * kGravity * kStep);
    other.softBodies().pop_back();
    other.step(2);
    one.step(2);
    EXPECT_EQ(fem.stepReport(&cube).m_flags & BT_FEM_OTHER_WORLD, 0);
    EXPECT_TRUE(allFinite(cube));
}

TEST_P(LifecycleOfWorlds, ABodyInWorldsOfTwoSolversIsSteppedByOne)
{
    btFemSoftBodySolver firstFem, secondFem;
    SoftWorld first(GetParam(), firstFem), second(GetParam(), secondFem);
    btSoftBody& cube = first.addSoft(makeCube(first));
    first.step(2);
    second.softBodies().push_back(&cube);  // the body still refers to the first solver
    for (int k = 0; k < 10; ++k)
    {
        first.step();
        second.step();
    }
    EXPECT_TRUE(secondFem.stepReport(&cube).m_flags & BT_FEM_OTHER_WORLD);
    EXPECT_NEAR(velocityOf(cube).z, -kGravity * 12 * kStep, 1e-4);
    second.softBodies().pop_back();
    second.step();
    first.step();
    EXPECT_EQ(firstFem.stepReport(&cube).m_flags, 0);
}

TEST_P(LifecycleOfWorlds, ASolverOutlivesItsWorldAndServesTheNext)
{
    btFemSoftBodySolver fem;
    for (int k = 0; k < 3; ++k)
    {
        SoftWorld world(GetParam(), fem);
        world.addPlane();
        btSoftBody& cube = world.addSoft(makeCube(world, btVector3(0, 0, btScalar(0.51))));
        world.step(120);
        EXPECT_EQ(fem.stepReport(&cube).m_flags, 0);
        EXPECT_NEAR(impulseOn(fem, cube).z / kStep, massOf(cube) * kGravity, 0.01 * massOf(cube) * kGravity);
    }
}

TEST_P(LifecycleOfWorlds, TwoWorldsMayTakeTurnsWithOneSolver)
{
    btFemSoftBodySolver fem;
    SoftWorld one(GetParam(), fem), other(GetParam(), fem);
    btSoftBody& cube = one.addSoft(makeCube(one));
    btSoftBody& twin = other.addSoft(makeCube(other));
    for (int k = 0; k < 30; ++k)
    {
        one.step();
        other.step();
    }
    EXPECT_EQ(fem.stepReport(&cube).m_flags, 0);
    EXPECT_EQ(bitsOf(cube), bitsOf(twin));
    EXPECT_NEAR(velocityOf(cube).z, -kGravity * 30 * kStep, 1e-4);
}

/// The object that a tick callback deletes, between collision detection and the FEM solve.
struct Deletion
{
    SoftWorld* m_world;
    btSoftBody* m_soft;
    btRigidBody* m_rigid;
};

void deleteInTick(btDynamicsWorld* world, btScalar)
{
    auto* deletion = static_cast<Deletion*>(world->getWorldUserInfo());
    if (deletion->m_soft) deletion->m_world->deleteSoft(*deletion->m_soft);
    if (deletion->m_rigid) deletion->m_world->deleteRigid(*deletion->m_rigid);
    deletion->m_soft = nullptr;
    deletion->m_rigid = nullptr;
}

TEST_P(Lifecycle, BodiesMayBeDeletedBetweenCollisionAndSolve)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    btRigidBody& floor = world.addFloorBox();
    btSoftBody& cube = world.addSoft(makeCube(world, btVector3(0, 0, btScalar(0.51))));
    btSoftBody& doomed = world.addSoft(makeCube(world, btVector3(3, 0, btScalar(0.51))));
    world.step(60);
    ASSERT_GT(fem.contacts(&doomed).size(), 0);

    Deletion deletion = {&world, &doomed, nullptr};
    world.bullet().setInternalTickCallback(deleteInTick, &deletion);
    world.step();
    EXPECT_EQ(deletion.m_soft, nullptr);
    world.step(20);
    EXPECT_GT(fem.contacts(&cube).size(), 0);

    deletion.m_rigid = &floor;
    world.step();
    EXPECT_EQ(fem.contacts(&cube).size(), 0);
    world.step(20);
    EXPECT_LT(velocityOf(cube).z, -0.9 * kGravity * 20 * kStep);
    EXPECT_TRUE(allFinite(cube));
}

// Bullet makes the leaf of a body's broad-phase tree with its collision margin, 25 cm, and does not shrink it by
// itself.
TEST_P(Lifecycle, SmallBodiesHalfAMetreApartDoNotOverlap)
{
    FemWorld world(GetParam());
    const btVector3 size(btScalar(0.1), btScalar(0.1), btScalar(0.1));
    for (int i = 0; i < 9; ++i)
    {
        const btVector3 center(btScalar(0.5) * btScalar(i % 3), btScalar(0.5) * btScalar(i / 3), 0);
        btSoftBody& cube = world.addSoft(btFemHelpers::createBox(world.info(), center, size, size.x()));
        if (i % 2 == 0) cube.setActivationState(ISLAND_SLEEPING);
    }
    world.step(2);
    EXPECT_EQ(world.info().m_broadphase->getOverlappingPairCache()->getNumOverlappingPairs(), 0);
}

TEST_P(Lifecycle, KeysNeverAddedAreForgotten)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    const std::unique_ptr<btSoftBody> never(makeCube(world)), forgotten(makeCube(world));
    fem.prepare(never.get(), kStep);
    fem.prepare(forgotten.get(), kStep);
    EXPECT_TRUE(fem.isFem(never.get()));
    fem.forget(forgotten.get());
    EXPECT_FALSE(fem.isFem(forgotten.get()));
    world.step();
    EXPECT_FALSE(fem.isFem(never.get()));
}

// A FEM body whose elements a program breaks is handed back to Bullet, with Bullet's contacts, from the next step on.
// With and without the body's update flag its constants are updated without Bullet's node tree, which never terminates
// for a body without links.
class BrokenBody : public EachWorldWith<bool>
{
};

TEST_P(BrokenBody, MovesAndCollidesAsInBulletAlone)
{
    btDefaultSoftBodySolver plain;
    FemWorld world(worldClass());
    btFemSoftBodySolver& fem = world.fem();
    SoftWorld other(worldClass(), plain);
    world.addFloorBox();
    other.addFloorBox();
    btSoftBody& body = world.addSoft(makeCube(world, btVector3(0, 0, btScalar(0.55))));
    btSoftBody& twin = other.addSoft(makeCube(other, btVector3(0, 0, btScalar(0.55))));
    world.step(40);
    ASSERT_GT(fem.contacts(&body).size(), 0);

    body.m_tetras[0].m_n[1] = body.m_tetras[0].m_n[0];
    body.activate();
    body.m_bUpdateRtCst = value();
    twin.m_bUpdateRtCst = false;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        twin.m_nodes[i].m_x = twin.m_nodes[i].m_q = body.m_nodes[i].m_x;
        twin.m_nodes[i].m_v = body.m_nodes[i].m_v;
    }
    world.step(30);
    other.step(30);
    EXPECT_FALSE(fem.isFem(&body));
    EXPECT_TRUE(allFinite(body));
    double lowest = 1, furthest = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        lowest = std::min<double>(lowest, body.m_nodes[i].m_x.z());
        furthest = std::max<double>(furthest, (body.m_nodes[i].m_x - twin.m_nodes[i].m_x).length());
    }
    EXPECT_GT(lowest, -0.1);    // it would have fallen by 1.2 m
    EXPECT_LT(furthest, 1e-3);  // [m]
}

INSTANTIATE_TEST_SUITE_P(Lifecycle, BrokenBody,
                         testing::Combine(testing::Values(WorldClass::softRigid, WorldClass::softMultiBody),
                                          testing::Bool()),
                         nameOfWorldWith([](bool asked) { return asked ? "constantsAsked" : "constantsLeft"; }));

// Bullet's deformable world does not move bodies without links.
TEST(BrokenBodyInADeformableWorld, StandsStillAndSaysWhyUntilItIsMended)
{
    FemWorld world(WorldClass::deformable);
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& body = world.addSoft(makeCube(world));
    world.step(10);
    btSoftBody::Node*& corner = body.m_tetras[0].m_n[1];
    btSoftBody::Node* const whole = corner;
    corner = body.m_tetras[0].m_n[0];
    world.step(8);  // all elements have been checked
    const std::vector<btScalar> before = bitsOf(body);
    world.step(5);
    EXPECT_FALSE(fem.isFem(&body));
    EXPECT_EQ(fem.stepReport(&body).m_flags, BT_FEM_REJECTED);
    EXPECT_NE(std::string(fem.stepReport(&body).m_message).find("element 0"), std::string::npos);
    EXPECT_EQ(bitsOf(body), before);
    corner = whole;
    fem.setMaterial(&body, btFemMaterial::rubber());
    world.step(5);
    EXPECT_TRUE(fem.isFem(&body));
    EXPECT_EQ(fem.stepReport(&body).m_flags & BT_FEM_REJECTED, 0);
    EXPECT_LT(velocityOf(body).z, -kGravity * 14 * kStep);
}

}  // namespace
}  // namespace bullet_fem
