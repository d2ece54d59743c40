// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bridge/bridge_test_shapes.h"
#include "bridge/concave_test_shapes.h"
#include "bridge/contact_finder_scene.h"
#include "bullet_bridge/geometry/shapes/triangle_soup.h"

namespace bullet_fem
{
namespace
{

/// The unit cube, its bottom at z = 0, and an object of a concave shape.
class SheetContactTest : public ContactFinderScene
{
protected:
    using ContactFinderScene::find;
    const std::vector<ContactPoint>& find(const ConcaveShape& shape, btScalar z = 0)
    {
        m_ground.setCollisionShape(&shape.shape());
        m_ground.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, z)));
        return find(m_ground);
    }
    void move(const Vec3& way)
    {
        for (Vec3& x : m_fem.m_body.m_state.m_x) x += way;
    }
    void setVelocity(const Vec3& velocity)
    {
        for (Vec3& v : m_fem.m_body.m_state.m_v) v = velocity;
    }
    /// Each of the nine lower nodes has exactly one contact with this normal and gap, and there are no others.
    void expectFlat(const Vec3& normal, double gap)
    {
        EXPECT_EQ(m_fem.m_memory.m_contacts.size(), 9u);
        int lastNode = -1;
        for (const ContactPoint& c : m_fem.m_memory.m_contacts)
        {
            EXPECT_GT(c.m_soft.m_nodes[0], lastNode) << "one a node";
            lastNode = c.m_soft.m_nodes[0];
            EXPECT_EQ(c.m_soft.m_weights[0], 1);
            EXPECT_NEAR(norm(c.m_normal - normal), 0, 1e-12);
            EXPECT_NEAR(c.m_gap, gap, 1e-7) << "Bullet's coordinates are floats";
        }
    }

    btCollisionObject m_ground;
};

class FlatSheetTest : public SheetContactTest, public ::testing::WithParamInterface<NamedConcave>
{
protected:
    ConcaveShape m_sheet = GetParam().m_make({});
    btScalar m_atZero = -GetParam().m_height;
};

std::string concaveName(const ::testing::TestParamInfo<NamedConcave>& info)
{
    return info.param.m_name;
}
INSTANTIATE_TEST_SUITE_P(Shapes, FlatSheetTest, ::testing::ValuesIn(concaveShapes()), concaveName);

TEST_P(FlatSheetTest, EveryNodeHasOneContactWithTheNormalOfThePlane)
{
    for (double z : {0.0, 0.01, -0.01})
    {
        move({0, 0, z});
        find(m_sheet, m_atZero);
        expectFlat({0, 0, 1}, z);
        move({0, 0, -z});
        m_fem.m_memory.m_sheetSides.clear();
    }
    EXPECT_FALSE(m_report.m_unknownShape);
}

TEST_P(FlatSheetTest, ABodyBelowStaysBelow)
{
    move({0.03, 0.02, -1.001});
    find(m_sheet, m_atZero);
    expectFlat({0, 0, -1}, 0.001);
}

TEST_P(FlatSheetTest, PenetratingBodyIsPushedBackWhileSliding)
{
    move({0.013, 0.007, 0.001});
    find(m_sheet, m_atZero);
    move({0, 0, -0.0011});
    for (int k = 0; k < 20; ++k)
    {
        find(m_sheet, m_atZero);
        expectFlat({0, 0, 1}, -0.0001);
        move({0.03, -0.02, 0});
    }
}

TEST_P(FlatSheetTest, FlushBodyStaysOnItsSideDespiteRounding)
{
    move({0.013, 0.007, 0});
    for (double z : {0.0, 1e-18, -1e-18, 1e-16, -1e-16, 1e-12, -1e-12, 1e-9, -1e-9, 1e-7, -1e-7, 1e-5, -1e-5, 0.0})
    {
        move({0.03, -0.02, z});
        find(m_sheet, m_atZero);
        expectFlat({0, 0, 1}, z);
        move({0, 0, -z});
    }
}

TEST_P(FlatSheetTest, BodyThatPassedThroughInAStepIsBroughtBack)
{
    move({0.013, 0.007, 0.2});
    setVelocity({0, 0, -24});
    find(m_sheet, m_atZero);
    move({0, 0, -0.4});
    setVelocity({0, 0, 0});
    for (int k = 0; k < 3; ++k)
    {
        find(m_sheet, m_atZero);
        expectFlat({0, 0, 1}, -0.2);
    }
}

TEST_P(FlatSheetTest, TeleportedBodyIsOnItsNewSide)
{
    move({0.013, 0.007, 0.001});
    find(m_sheet, m_atZero);
    move({0, 0, -1.002});
    find(m_sheet, m_atZero);
    expectFlat({0, 0, -1}, 0.001);
}

TEST_P(FlatSheetTest, FastBodyIsStoppedAtTheSheet)
{
    for (double speed : {10.0, 100.0, 1000.0})
    {
        move({0, 0, 0.9 * speed * kStep});
        setVelocity({0, 0, -speed});
        find(m_sheet, m_atZero);
        EXPECT_GE(m_fem.m_memory.m_contacts.size(), 9u);
        for (int i = 0; i < 9; ++i) EXPECT_NEAR(m_fem.m_memory.m_contacts[i].m_gap, 0.9 * speed * kStep, 1e-6 * speed);
        setVelocity({0, 0, speed});
        EXPECT_TRUE(find(m_sheet, m_atZero).empty());
        move({0, 0, -0.9 * speed * kStep});
        m_fem.m_memory.m_sheetSides.clear();
    }
}

TEST_P(FlatSheetTest, TheContactOffsetAndTheMarginAreTakenOffTheGap)
{
    static_cast<btConcaveShape&>(*m_sheet.m_parts.front()).setMargin(btScalar(0.03125));
    m_fem.m_settings.m_contactOffset = 0.0625;
    find(m_sheet, m_atZero);
    const double scaledHasItsOwn = GetParam().m_name == "scaledMesh" ? 0 : 0.03125;
    expectFlat({0, 0, 1}, -0.0625 - scaledHasItsOwn);
}

TEST_P(FlatSheetTest, KinematicSheetIsUsedAtItsPoseAtStepStart)
{
    m_ground.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    m_ground.setInterpolationLinearVelocity({0, 0, 3});
    find(m_sheet, m_atZero + btScalar(3 * kStep));  // it has already moved
    ASSERT_NEAR(m_rigidProxies.rigidProxies().at(0).m_linearVelocity.z, 3, 1e-6);
    expectFlat({0, 0, 1}, 0);
}

// Rows add the arcs of its points (Drum).
TEST_F(SheetContactTest, RotatingKinematicSheetHasItsNormalAtTheEndOfTheStep)
{
    constexpr double turn = 0.05, height = 2;  // rotation within the step [rad], and height of the axis [m]
    GridSettings below;
    below.m_height = [](btScalar, btScalar) { return -btScalar(height); };
    const ConcaveShape shape = makeTriangleMesh(below);
    m_ground.setCollisionShape(&shape.shape());
    m_ground.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    m_ground.setInterpolationAngularVelocity({btScalar(turn / kStep), 0, 0});
    m_ground.setWorldTransform(
        btTransform(btQuaternion(btVector3(1, 0, 0), btScalar(turn)), btVector3(0, 0, btScalar(height))));
    find(m_ground);
    ASSERT_EQ(m_fem.m_memory.m_contacts.size(), 9u);
    for (const ContactPoint& c : m_fem.m_memory.m_contacts)
    {
        EXPECT_NEAR(c.m_gap, 0, 5e-5);
        EXPECT_LT(norm(c.m_normal - Vec3{0, -std::sin(turn), std::cos(turn)}), 1e-3);
    }
}

TEST_F(SheetContactTest, ACornerHasOneContactAFace)
{
    ConcaveShape shape;
    addGrid(*shape.m_mesh, {});
    for (btScalar y : {-1, 0, 1})  // a wall at x = 0, from below the floor to above the cube
    {
        shape.m_mesh->addTriangle({0, y, -1}, {0, y + 1, -1}, {0, y + 1, 2});
        shape.m_mesh->addTriangle({0, y, -1}, {0, y, 2}, {0, y + 1, 2});
    }
    shape.make<btBvhTriangleMeshShape>(shape.m_mesh.get(), true);
    move({0.001, 0.3, 0.001});
    find(shape);
    EXPECT_EQ(m_fem.m_memory.m_contacts.size(), 18u);
    move({-0.002, 0.01, -0.002});
    find(shape);
    EXPECT_EQ(m_fem.m_memory.m_contacts.size(), 18u);
    for (const ContactPoint& c : m_fem.m_memory.m_contacts)
    {
        EXPECT_NEAR(c.m_gap, -0.001, 1e-7);
        EXPECT_NEAR(norm(c.m_normal - Vec3{1, 0, 0}) * norm(c.m_normal - Vec3{0, 0, 1}), 0, 1e-12);
    }
}

/// A roof along y with its ridge at x and z = 0.
ConcaveShape makeRoof(btScalar slope, btScalar x)
{
    ConcaveShape shape;
    for (btScalar side : {-1, 1})
    {
        shape.m_mesh->addTriangle({x, -3, 0}, {x, 4, 0}, {x + side, -3, -slope});
        shape.m_mesh->addTriangle({x + side, 4, -slope}, {x, 4, 0}, {x + side, -3, -slope});
    }
    shape.make<btBvhTriangleMeshShape>(shape.m_mesh.get(), true);
    return shape;
}

TEST_F(SheetContactTest, RidgeBetweenNodesContactsTheEdgesAcross)
{
    for (btScalar slope : {btScalar(0.5), btScalar(4)})
    {
        const ConcaveShape roof = makeRoof(slope, btScalar(0.25));
        find(roof, btScalar(0.001));
        EXPECT_GE(m_fem.m_memory.m_contacts.size(), 5u) << "three edges across and the diagonals";
        for (const ContactPoint& c : m_fem.m_memory.m_contacts)
        {
            EXPECT_NEAR(norm(c.m_normal - Vec3{0, 0, 1}), 0, 1e-9);
            EXPECT_NEAR(c.m_gap, -0.001, 1e-7);
            EXPECT_NEAR(c.m_point.x, 0.25, 1e-7);
        }
    }
}

TEST_F(SheetContactTest, NodeAboveARidgeContactsIt)
{
    const ConcaveShape roof = makeRoof(2, btScalar(0.5));
    find(roof, btScalar(-0.001));
    EXPECT_EQ(m_fem.m_memory.m_contacts.size(), 3u);
    for (const ContactPoint& c : m_fem.m_memory.m_contacts)
    {
        EXPECT_NEAR(norm(c.m_normal - Vec3{0, 0, 1}), 0, 1e-9);
        EXPECT_NEAR(c.m_gap, 0.001, 1e-7);
    }
}

TEST_F(SheetContactTest, ThinSpikeContactsTheTriangleOnItsTip)
{
    ConcaveShape shape;
    const btVector3 tip(btScalar(0.3), btScalar(0.35), btScalar(0.002));
    const btVector3 base[3] = {{btScalar(0.29), btScalar(0.35), -1},
                               {btScalar(0.31), btScalar(0.34), -1},
                               {btScalar(0.31), btScalar(0.36), -1}};
    for (int k = 0; k < 3; ++k) shape.m_mesh->addTriangle(base[k], base[(k + 1) % 3], tip);
    addGrid(*shape.m_mesh, {10, 2, true, [](btScalar, btScalar) { return btScalar(-1); }});
    shape.make<btBvhTriangleMeshShape>(shape.m_mesh.get(), true);
    find(shape);
    ASSERT_EQ(m_fem.m_memory.m_contacts.size(), 1u);
    const ContactPoint& c = m_fem.m_memory.m_contacts[0];
    EXPECT_NEAR(c.m_gap, -0.002, 1e-7);
    EXPECT_NEAR(norm(c.m_normal - Vec3{0, 0, 1}), 0, 1e-9);
    EXPECT_NEAR(norm(c.m_point - Vec3{0.3, 0.35, 0}), 0, 1e-6);
    EXPECT_GE(m_fem.m_memory.m_origins[0].m_triangle, 0);
}

TEST_F(SheetContactTest, BodyHittingASlopeSidewaysIsStoppedOrBroughtBack)
{
    GridSettings valley;
    valley.m_cells = 16;
    valley.m_halfSize = 4;
    valley.m_height = [](btScalar x, btScalar) { return x > 1 ? btScalar(0.5) * (x - 1) : 0; };
    const ConcaveShape shape = makeTriangleMesh(valley);
    move({-0.75, 0.013, 1e-4});
    setVelocity({60, 0, 0});  // 1 m a step along the floor, and 0.25 m into the slope
    find(shape);
    const auto blocks = [](const ContactPoint& c) { return c.m_normal.x < -0.1; };
    EXPECT_TRUE(std::any_of(m_fem.m_memory.m_contacts.begin(), m_fem.m_memory.m_contacts.end(), blocks));
    move({1, 0, 0});
    find(shape);
    EXPECT_NEAR(deepest()->m_normal.z, std::cos(std::atan(0.5)), 1e-6);
    EXPECT_NEAR(deepest()->m_gap, -0.125 * std::cos(std::atan(0.5)), 1e-3);
}

TEST_F(SheetContactTest, SlippingOffAThinEdgeIsNotHeldByTheFaceBehind)
{
    // An acute wedge whose upper face is the floor: above it the lower face makes no contact.
    ConcaveShape shape;
    shape.m_mesh->addTriangle({btScalar(0.9), -3, 0}, {btScalar(0.9), 4, 0}, {-2, -3, 0});
    shape.m_mesh->addTriangle({btScalar(0.9), 4, 0}, {-2, 4, 0}, {-2, -3, 0});
    shape.m_mesh->addTriangle({btScalar(0.9), -3, 0}, {btScalar(0.9), 4, 0}, {-2, -3, -1});
    shape.m_mesh->addTriangle({btScalar(0.9), 4, 0}, {-2, 4, -1}, {-2, -3, -1});
    shape.make<btBvhTriangleMeshShape>(shape.m_mesh.get(), true);
    move({0, 0, 0.001});
    setVelocity({30, 0, 0});
    find(shape);
    EXPECT_EQ(m_fem.m_memory.m_contacts.size(), 11u) << "six nodes, and five edges that cross the rim";
    for (const ContactPoint& c : m_fem.m_memory.m_contacts) EXPECT_NEAR(c.m_normal.z, 1, 1e-9);
}

TEST_F(SheetContactTest, DegenerateTrianglesAreOmitted)
{
    ConcaveShape shape;
    addGrid(*shape.m_mesh, {});
    const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();
    shape.m_mesh->addTriangle({0, 0, 0}, {1, 1, 0}, {2, 2, 0});
    shape.m_mesh->addTriangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0});
    addGrid(*shape.m_mesh, {});  // each triangle twice, with opposite winding
    shape.make<btGImpactMeshShape>(shape.m_mesh.get());
    auto& gimpact = static_cast<btGImpactMeshShape&>(shape.shape());
    gimpact.setMargin(0);
    gimpact.updateBound();
    TriangleSoup soup;
    soup.collect(leafOf(shape.shape()), {-9, -9, -9}, {9, 9, 9});
    EXPECT_EQ(soup.triangles().size(), 400u);
    move({0.003, 0.002, 0});
    find(shape);
    expectFlat({0, 0, 1}, 0);
    const btScalar heights[4] = {nan, 0, 0, 0};
    btHeightfieldTerrainShape field(2, 2, heights, 1, -1, 1, 2, PHY_FLOAT, false);
    field.setLocalScaling({4, 4, 1});
    m_ground.setCollisionShape(&field);
    for (const ContactPoint& c : find(m_ground)) EXPECT_TRUE(isFinite(c.m_normal) && std::isfinite(c.m_gap));
    EXPECT_FALSE(m_fem.m_memory.m_contacts.empty());
}

TEST_F(SheetContactTest, EmptyMeshMakesNoContact)
{
    ConcaveShape shape;
    shape.make<btGImpactMeshShape>(shape.m_mesh.get());
    EXPECT_TRUE(find(shape).empty());
    addGrid(*shape.m_mesh, {});
    EXPECT_TRUE(find(shape).empty()) << "nobody called updateBound(): Bullet's rigid bodies do not see it either";
    ConcaveShape noTree;
    addGrid(*noTree.m_mesh, {});
    noTree.make<btBvhTriangleMeshShape>(noTree.m_mesh.get(), true, false);
    EXPECT_TRUE(find(noTree).empty());
    EXPECT_TRUE(m_report.m_unknownShape) << "Bullet would follow a null pointer";
    ConcaveShape flat;
    addGrid(*flat.m_mesh, {});
    auto& mesh = flat.make<btBvhTriangleMeshShape>(flat.m_mesh.get(), true);
    flat.make<btScaledBvhTriangleMeshShape>(&mesh, btVector3(1, 1, 0));
    EXPECT_TRUE(find(flat).empty());
    EXPECT_TRUE(m_report.m_unknownShape);
}

}  // namespace
}  // namespace bullet_fem
