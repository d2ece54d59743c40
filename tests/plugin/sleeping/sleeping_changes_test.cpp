// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>
#include <tuple>
#include <vector>

#include "BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h"
#include "BulletCollision/Gimpact/btGImpactShape.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/sleeping_world.h"

namespace bullet_fem
{
namespace
{

constexpr btScalar kTop = btScalar(0.2);   // height of a board [m]
constexpr btScalar kHalf = btScalar(0.1);  // half of it
constexpr int kCells = 4;                  // along each side of a mesh or heightfield

// A cube asleep on a board on the ground; changes of the board do not move its centre.
class SleepingOnBoard : public SleepingScene
{
protected:
    explicit SleepingOnBoard(Coupling coupling) : SleepingScene(coupling) { addGround(); }

    void restOn(btCollisionShape* shape)
    {
        m_board = &m_world.addRigid(shape, {0, at(0, 0, kHalf)});
        m_board->forceActivationState(ISLAND_SLEEPING);
        m_cube = &addCube(0, kTop + btScalar(0.01));
        sleepAll(*m_cube);
    }

public:
    btCollisionShape* box(btScalar halfHeight)
    {
        return m_world.keep(new btBoxShape(btVector3(btScalar(0.5), btScalar(0.5), halfHeight)));
    }

    // A cylinder with the box's bounds.
    btCollisionShape* cylinder()
    {
        return m_world.keep(new btCylinderShapeZ(btVector3(btScalar(0.5), btScalar(0.5), kHalf)));
    }

    // A compound of one box below the cube, and one 5 m beside it.
    btCollisionShape* compound(bool tree)
    {
        auto* shape = new btCompoundShape(tree);
        shape->addChildShape(btTransform::getIdentity(), box(kHalf));
        shape->addChildShape(at(5, 0, 0), box(kHalf));
        return shape;
    }

    btCollisionShape* hull()
    {
        auto* shape = new btConvexHullShape;
        shape->setMargin(btScalar(0.04));
        for (int k = 0; k < 8; ++k)
            shape->addPoint(
                btVector3(btScalar(k & 1 ? 0.5 : -0.5), btScalar(k & 2 ? 0.5 : -0.5), btScalar(k & 4 ? 0.06 : -0.06)));
        return shape;
    }

    // A sheet of 2 x 2 m at the height of the board's upper face.
    btCollisionShape* mesh()
    {
        makeArrays();
        return new btBvhTriangleMeshShape(m_arrays.get(), false);
    }

    btCollisionShape* gimpactMesh()
    {
        makeArrays();
        auto* shape = new btGImpactMeshShape(m_arrays.get());
        shape->setMargin(0);
        shape->updateBound();
        return shape;
    }

    void makeArrays()
    {
        constexpr int kPoints = kCells + 1;
        for (int i = 0; i < kPoints * kPoints; ++i)
            m_corners.emplace_back(btScalar(0.5) * btScalar(i % kPoints) - 1, btScalar(0.5) * btScalar(i / kPoints) - 1,
                                   kHalf);
        for (int i = 0; i < kPoints * kPoints; ++i)
            if (i % kPoints < kCells && i / kPoints < kCells)
                m_triangles.insert(m_triangles.end(), {i, i + 1, i + kPoints, i + 1, i + kPoints + 1, i + kPoints});
        m_arrays = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(m_triangles.size() / 3), m_triangles.data(), static_cast<int>(3 * sizeof(int)),
            static_cast<int>(m_corners.size()), &m_corners[0][0], static_cast<int>(sizeof(btVector3)));
    }

    void lowerMesh()
    {
        for (btVector3& corner : m_corners) corner.setZ(kHalf - btScalar(0.05));
    }

    // A heightfield of that size and place, with heights between 0 and kTop.
    btCollisionShape* heightfield()
    {
        constexpr int kPoints = kCells + 1;
        m_heights.assign(kPoints * kPoints, kTop);
        return new btHeightfieldTerrainShape(kPoints, kPoints, m_heights.data(), 1, 0, kTop, 2, PHY_FLOAT, false);
    }

    btCompoundShape& children() { return *static_cast<btCompoundShape*>(m_board->getCollisionShape()); }

    btSoftBody* m_cube = nullptr;
    btRigidBody* m_board = nullptr;
    std::vector<btVector3> m_corners;
    std::vector<int> m_triangles;
    std::unique_ptr<btTriangleIndexVertexArray> m_arrays;
    std::vector<btScalar> m_heights;  // Bullet reads btScalar for PHY_FLOAT
};

// A change of the board by the program.
struct Change
{
    const char* m_name;
    std::function<btCollisionShape*(SleepingOnBoard&)> m_shape;
    std::function<void(SleepingOnBoard&)> m_do;
    btScalar m_top = kTop;  // final height of the cube's lower face [m]
};

void PrintTo(const Change& change, std::ostream* stream)
{
    *stream << change.m_name;
}

class SleepingOnChanged : public SleepingOnBoard, public testing::TestWithParam<std::tuple<Coupling, Change>>
{
protected:
    SleepingOnChanged() : SleepingOnBoard(std::get<0>(GetParam())) {}
};

TEST_P(SleepingOnChanged, WakesAndRestsOnTheChangedShape)
{
    const Change& change = std::get<1>(GetParam());
    restOn(change.m_shape(*this));
    const std::vector<btScalar> asleep = bitsOf(*m_cube);
    m_world.step(60);
    ASSERT_EQ(m_cube->getActivationState(), ISLAND_SLEEPING);
    ASSERT_EQ(bitsOf(*m_cube), asleep);
    change.m_do(*this);
    m_world.step();
    EXPECT_TRUE(m_cube->isActive());
    EXPECT_GT(m_fem.stepReport(m_cube).m_freeMotionMs, 0);  // 0 for a body asleep in the step
    m_world.step(kFiveSeconds - 1);
    EXPECT_NEAR(lowestHeight(*m_cube), change.m_top, 1e-3);
    EXPECT_FALSE(m_cube->isActive());
}

btCollisionShape* plainBox(SleepingOnBoard&)
{
    return new btBoxShape(btVector3(btScalar(0.5), btScalar(0.5), kHalf));
}

btCollisionShape* compoundWithTree(SleepingOnBoard& scene)
{
    return scene.compound(true);
}

btCollisionShape* compoundWithoutTree(SleepingOnBoard& scene)
{
    return scene.compound(false);
}

btCollisionShape* sheet(SleepingOnBoard& scene)
{
    return scene.mesh();
}

void setScaling(SleepingOnBoard& scene, btScalar z)
{
    scene.m_board->getCollisionShape()->setLocalScaling(btVector3(1, 1, z));
}

const Change kChanges[] = {
    {"Shape", plainBox, [](SleepingOnBoard& s) { s.m_board->setCollisionShape(s.box(kHalf / 2)); }, btScalar(0.15)},
    {"ShapeOfTheSameBounds", plainBox, [](SleepingOnBoard& s) { s.m_board->setCollisionShape(s.cylinder()); }},
    {"Scaling", plainBox, [](SleepingOnBoard& s) { setScaling(s, btScalar(0.5)); }, btScalar(0.15)},
    {"Growth", plainBox, [](SleepingOnBoard& s) { setScaling(s, btScalar(1.2)); }, btScalar(0.22)},
    {"Margin", [](SleepingOnBoard& s) { return s.hull(); },
     [](SleepingOnBoard& s) { s.m_board->getCollisionShape()->setMargin(btScalar(0.02)); }, btScalar(0.18)},
    {"Corners", [](SleepingOnBoard& s) { return s.hull(); },
     [](SleepingOnBoard& s)
     {
         // The new point is within the hull of the others.
         static_cast<btConvexHullShape*>(s.m_board->getCollisionShape())
             ->addPoint(btVector3(btScalar(0.2), btScalar(0.1), btScalar(0.06)));
     }},
    {"Friction", plainBox, [](SleepingOnBoard& s) { s.m_board->setFriction(btScalar(0.1)); }},
    {"Restitution", plainBox, [](SleepingOnBoard& s) { s.m_board->setRestitution(btScalar(0.5)); }},
    {"ContactStiffness", plainBox,
     [](SleepingOnBoard& s) { s.m_board->setContactStiffnessAndDamping(btScalar(1e6), 100); }},
    {"Ignored", plainBox, [](SleepingOnBoard& s) { s.m_board->setIgnoreCollisionCheck(s.m_cube, true); }, 0},
    {"ChildMoved", compoundWithTree,
     [](SleepingOnBoard& s) { s.children().updateChildTransform(0, at(0, 0, btScalar(-0.05))); }, btScalar(0.15)},
    {"ChildMovedWithoutTree", compoundWithoutTree,
     [](SleepingOnBoard& s) { s.children().updateChildTransform(0, at(0, 0, btScalar(-0.05))); }, btScalar(0.15)},
    {"ChildScaled", compoundWithTree,
     [](SleepingOnBoard& s) { s.children().getChildShape(0)->setLocalScaling(btVector3(1, 1, btScalar(0.5))); },
     btScalar(0.15)},
    {"ChildRemoved", compoundWithTree, [](SleepingOnBoard& s) { s.children().removeChildShapeByIndex(0); }, 0},
    {"ChildAdded", compoundWithTree,
     [](SleepingOnBoard& s) { s.children().addChildShape(at(0, 0, btScalar(0.02)), s.box(kHalf)); }, btScalar(0.22)},
    {"CompoundScaled", compoundWithTree, [](SleepingOnBoard& s) { setScaling(s, btScalar(0.5)); }, btScalar(0.15)},
    {"MeshMoved", sheet,
     [](SleepingOnBoard& s)
     {
         s.lowerMesh();
         const btVector3 half(1, 1, kHalf);
         static_cast<btBvhTriangleMeshShape*>(s.m_board->getCollisionShape())->refitTree(-half, half);
     },
     btScalar(0.15)},
    {"GImpactMoved", [](SleepingOnBoard& s) { return s.gimpactMesh(); },
     [](SleepingOnBoard& s)
     {
         s.lowerMesh();
         auto& mesh = *static_cast<btGImpactMeshShape*>(s.m_board->getCollisionShape());
         mesh.postUpdate();
         mesh.updateBound();
     },
     btScalar(0.15)},
    {"GroundDug", [](SleepingOnBoard& s) { return s.heightfield(); },
     [](SleepingOnBoard& s)
     {
         for (int y = 1; y < kCells; ++y)
             for (int x = 1; x < kCells; ++x) s.m_heights[y * (kCells + 1) + x] = kTop - btScalar(0.05);
     },
     btScalar(0.15)},
};

INSTANTIATE_TEST_SUITE_P(
    Changes, SleepingOnChanged,
    testing::Combine(testing::Values(Coupling::swap, Coupling::coupled), testing::ValuesIn(kChanges)),
    [](const auto& suite)
    { return std::string(couplingName(std::get<0>(suite.param))) + "_" + std::get<1>(suite.param).m_name; });

class SleepingNearChanged : public SleepingOnBoard, public testing::TestWithParam<Coupling>
{
protected:
    SleepingNearChanged() : SleepingOnBoard(GetParam()) {}
};

TEST_P(SleepingNearChanged, SleepsOnWhileAFarChildShapeMoves)
{
    for (const bool tree : {true, false})
    {
        restOn(compound(tree));
        for (int k = 1; k <= 30; ++k)
        {
            children().updateChildTransform(1, at(5, 0, btScalar(0.01) * btScalar(k)));
            m_world.step();
            ASSERT_FALSE(m_cube->isActive()) << "step " << k;
        }
        m_world.deleteSoft(*m_cube);
        m_world.deleteRigid(*m_board);
    }
}

TEST_P(SleepingNearChanged, SleepsOnWhenTheSameIsSetAgain)
{
    restOn(compound(true));
    for (int k = 0; k < 30; ++k)
    {
        m_board->setFriction(m_board->getFriction());
        children().updateChildTransform(0, children().getChildTransform(0));
        children().setLocalScaling(children().getLocalScaling());
        m_world.step();
        ASSERT_FALSE(m_cube->isActive()) << "step " << k;
    }
}

TEST_P(SleepingNearChanged, WakesWhenAChildShapeComesToItsSide)
{
    restOn(compound(true));
    children().updateChildTransform(1, at(btScalar(0.65), 0, btScalar(0.2)));
    m_world.step();
    EXPECT_TRUE(m_cube->isActive());
}

TEST_P(SleepingNearChanged, WakesWhenItsLoadGrowsHeavier)
{
    btSoftBody& cube = addCube();
    btRigidBody& sphere = addSphere(btScalar(0.515), 5);
    sphere.setAngularFactor(0);
    m_world.step(3 * kFiveSeconds);
    ASSERT_FALSE(cube.isActive());
    sphere.setMassProps(10, btVector3(1, 1, 1));
    m_world.step();
    EXPECT_TRUE(cube.isActive());
    m_world.step(3 * kFiveSeconds);
    EXPECT_NEAR(m_fem.contactForce(&cube, &sphere).z(), -10 * kGravity, 1e-3 * 10 * kGravity);
}

TEST_P(SleepingNearChanged, WakesWhenASleepingRigidBodyGrowsIntoIt)
{
    btSoftBody& cube = addCube();
    btRigidBody& box = m_world.addRigid(new btBoxShape(btVector3(0.1, 0.1, 0.1)), {10, at(-1, 0, btScalar(0.1))});
    box.forceActivationState(ACTIVE_TAG);
    sleepAll(cube);
    ASSERT_FALSE(box.isActive());
    box.getCollisionShape()->setLocalScaling(btVector3(btScalar(8.2), 1, 1));
    m_world.step(2);
    EXPECT_TRUE(cube.isActive());
}

TEST_P(SleepingNearChanged, WakesWhenTheSoftBodyBelowIsOfAnotherMaterial)
{
    btSoftBody& lower = addCube();
    btSoftBody& upper = addCube(0, btScalar(0.42));
    m_world.step(2 * kFiveSeconds);
    ASSERT_FALSE(upper.isActive());
    lower.m_cfg.kDF = btScalar(0.1);
    m_world.step();
    EXPECT_TRUE(lower.isActive());
    EXPECT_TRUE(upper.isActive());
}

INSTANTIATE_TEST_SUITE_P(Couplings, SleepingNearChanged, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return std::string(couplingName(suite.param)); });

}  // namespace
}  // namespace bullet_fem
