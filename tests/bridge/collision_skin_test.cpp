// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/collision_skin.h"

#include <gtest/gtest.h>

#include "bridge/bridge_test_bodies.h"
#include "bullet_bridge/contact/contact_reduction.h"

namespace bullet_fem
{
namespace
{

/// The boundary of a mesh as a surface that follows it: every node in one of its tetrahedra.
std::vector<SkinVertex> verticesOf(const TetMesh& mesh)
{
    std::vector<SkinVertex> vertices(mesh.nodeCount());
    for (const Tet& t : mesh.tets())
        for (int a = 0; a < 4; ++a)
        {
            vertices[t[a]] = {t, {0, 0, 0, 0}};
            vertices[t[a]].m_weights[a] = 1;
        }
    return vertices;
}

int openEdgesOf(const CollisionSkin& skin)
{
    const SurfaceTopology topology(skin.rest().m_triangles, static_cast<int>(skin.rest().m_positions.size()));
    int count = 0;
    for (int edge = 0; edge < topology.edgeCount(); ++edge)
        count += topology.trianglesOf(edge)[0] == topology.trianglesOf(edge)[1];
    return count;
}

/// Volume between the triangles and a point; negative if they face inward.
double volumeOf(const CollisionSkin& skin, const Vec3& from)
{
    double volume = 0;
    const std::vector<Vec3>& x = skin.rest().m_positions;
    for (const Triangle& t : skin.rest().m_triangles)
        volume += dot(x[t[0]] - from, cross(x[t[1]] - from, x[t[2]] - from)) / 6;
    return volume;
}

class CollisionSkinTest : public testing::Test
{
protected:
    const TetMesh m_mesh = makeBox({1, 1, 1}, {2, 2, 2});
    const std::vector<SkinVertex> m_vertices = verticesOf(m_mesh);
    const Vec3 m_middle = {0.5, 0.5, 0.5};
};

TEST_F(CollisionSkinTest, BoundarySkinEqualsTheMeshSurface)
{
    const CollisionSkin skin(m_mesh, m_vertices, m_mesh.surface());
    EXPECT_EQ(skin.nodes(), m_mesh.surfaceNodes());
    EXPECT_EQ(skin.rest().m_nearestNode, m_mesh.surfaceNodes());
    EXPECT_EQ(skin.rest().m_triangles.size(), m_mesh.surface().size());
    EXPECT_EQ(skin.rest().m_meanEdge, m_mesh.meanEdgeLength());
    EXPECT_EQ(openEdgesOf(skin), 0);
    EXPECT_NEAR(volumeOf(skin, m_middle), 1, 1e-12);
}

TEST_F(CollisionSkinTest, RepairsDefects)
{
    std::vector<SkinVertex> vertices = m_vertices;
    vertices.push_back(vertices[m_mesh.surface()[0][0]]);  // the same place once more
    std::vector<Triangle> triangles = m_mesh.surface();
    const int twin = m_mesh.nodeCount();
    triangles[0][0] = twin;
    std::swap(triangles[5][0], triangles[5][1]);                               // turned over
    triangles.push_back(triangles[7]);                                         // a duplicate
    triangles.push_back({triangles[9][0], triangles[9][0], triangles[9][1]});  // without area
    triangles.erase(triangles.begin() + 20);                                   // a hole
    const CollisionSkin skin(m_mesh, vertices, triangles);
    EXPECT_EQ(skin.rest().m_positions.size(), m_mesh.surfaceNodes().size());
    EXPECT_EQ(skin.rest().m_triangles.size(), m_mesh.surface().size() - 1);
    EXPECT_EQ(openEdgesOf(skin), 3);
    EXPECT_NEAR(volumeOf(skin, m_middle), 1 - 1.0 / m_mesh.surface().size(), 1e-12);  // all faces are alike
}

TEST_F(CollisionSkinTest, IsTurnedOutwardUnlessItIsTheWallOfAHollow)
{
    std::vector<SkinVertex> vertices = m_vertices;
    std::vector<Triangle> triangles = m_mesh.surface();
    for (Triangle& t : triangles) std::swap(t[1], t[2]);
    EXPECT_NEAR(volumeOf(CollisionSkin(m_mesh, vertices, triangles), m_middle), 1, 1e-12);

    triangles = m_mesh.surface();
    const Tet& holder = m_mesh.tets()[3];  // a little tetrahedron in one of the elements, facing inward
    const int first = static_cast<int>(vertices.size());
    for (int a = 0; a < 4; ++a)
    {
        vertices.push_back({holder, {0.2, 0.2, 0.2, 0.2}});
        vertices.back().m_weights[a] = 0.4;
    }
    for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 3, 1}, Triangle{1, 3, 2}, Triangle{0, 2, 3}})
        triangles.push_back({first + t[0], first + t[1], first + t[2]});
    EXPECT_LT(volumeOf(CollisionSkin(m_mesh, vertices, triangles), m_middle), 1 - 1e-6);
    for (std::size_t k = triangles.size() - 4; k < triangles.size(); ++k) std::swap(triangles[k][1], triangles[k][2]);
    EXPECT_GT(volumeOf(CollisionSkin(m_mesh, vertices, triangles), m_middle),
              1 + 1e-6);  // within another, either is left
}

TEST_F(CollisionSkinTest, PointsAreSumsOfNodesEachOnce)
{
    std::vector<SkinVertex> vertices;  // of three elements that share nodes
    for (const int e : {0, 1, 2}) vertices.push_back({m_mesh.tets()[e], {0.1, 0.2, 0.3, 0.4}});
    const CollisionSkin skin(m_mesh, vertices, {{0, 1, 2}});
    const SurfacePoint point = skin.pointOf(7, {0, 1, 2}, {0.5, 0.3, 0.2});
    EXPECT_EQ(point.m_body, 7);
    EXPECT_EQ(point.m_count, static_cast<int>(skin.nodes().size()));
    EXPECT_LT(point.m_count, 12);
    double sum = 0;
    for (int a = 0; a < point.m_count; ++a)
    {
        sum += point.m_weights[a];
        for (int b = 0; b < a; ++b) EXPECT_NE(point.m_nodes[a], point.m_nodes[b]);
    }
    EXPECT_NEAR(sum, 1, 1e-15);
    std::vector<Vec3> moved = m_mesh.restPositions(), followed;
    for (Vec3& x : moved) x = {x.x + 2 * x.y * x.z, x.y - x.x * x.x, 3 * x.z};
    skin.follow(moved, followed);
    EXPECT_LT(norm(point.of(moved) - interpolated(followed, {0, 1, 2}, {0.5, 0.3, 0.2})), 1e-15);
}

TEST_F(CollisionSkinTest, SurfaceWithoutAreaIsRejected)
{
    EXPECT_THROW(CollisionSkin(m_mesh, m_vertices, {{0, 1, 0}, {2, 2, 2}}), std::invalid_argument);
}

/// Contacts of one object along x, 1 cm apart, in cells of 10 cm.
class Thinning : public testing::Test
{
protected:
    void add(double gap, bool held, const Vec3& normal = {0, 0, 1})
    {
        ContactPoint contact;
        contact.m_gap = gap;
        contact.m_normal = normal;
        contact.m_slop = 1e-4;
        const Vec3 place = {0.005 + 0.01 * static_cast<double>(m_contacts.size()), 0.05, 0.05};
        m_contacts.push_back(contact);
        m_origins.push_back(static_cast<int>(m_origins.size()));
        m_reduction.add({3, contact, place, gap, held});
    }

    std::vector<int> kept()
    {
        m_reduction.thin(m_contacts, m_origins);
        return m_origins;
    }

    Thinning() { m_reduction.clear(0.1); }

    ContactReduction m_reduction;
    std::vector<ContactPoint> m_contacts;
    std::vector<int> m_origins;
};

TEST_F(Thinning, KeepsTheDeepestOfEveryCell)
{
    for (int k = 0; k < 20; ++k) add(1e-3 * std::abs(k % 10 - 4), false);
    EXPECT_EQ(kept(), (std::vector<int>{4, 14}));
}

TEST_F(Thinning, KeepsLoadedContactsAndThoseDeeperBySlop)
{
    for (const double gap : {0.0, -5e-5, 1e-5, -2e-4, -3e-4}) add(gap, gap >= 0);
    EXPECT_EQ(kept(), (std::vector<int>{0, 2, 4}));
}

TEST_F(Thinning, KeepsOtherNormals)
{
    add(0, false);
    add(0, false, {1, 0, 0});
    add(1e-3, false, {0, 0, 1});
    EXPECT_EQ(kept(), (std::vector<int>{0, 1}));
}

}  // namespace
}  // namespace bullet_fem
