// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/rest_positions.h"

#include <gtest/gtest.h>

#include "bridge/bridge_test_bodies.h"

namespace bullet_fem
{
namespace
{

double largestError(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, norm(a[i] - b[i]));
    return largest;
}

std::vector<Vec3> relativeToFirst(const btSoftBody& body)
{
    std::vector<Vec3> x;
    for (int i = 0; i < body.m_nodes.size(); ++i) x.push_back(vec3(body.m_nodes[i].m_x) - vec3(body.m_nodes[0].m_x));
    return x;
}

// Along 40 cells rounding errors stay below 1e-5 of an edge.
TEST(RestPositions, AreFoundByWalkingOverTheElements)
{
    btSoftBodyWorldInfo info;
    const auto body = makeSoftBody(info, makeBox({4, .2, .2}, {40, 2, 2}));
    body->rotate(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(1)));
    body->initializeDmInverse();
    const std::vector<Vec3> rest = relativeToFirst(*body);
    for (int i = 1; i < body->m_nodes.size(); ++i)  // all but node 0, which is the reference point of the layout
        body->m_nodes[i].m_x += btVector3(0, 0, btScalar(0.05 * std::sin(7.0 * i)));
    const RestPositions found = restPositionsOf(*body, tetsOf(*body));
    EXPECT_TRUE(found.m_fromMatrices);
    // Only lengths are compared: the rest shape is rotated to fit the present positions.
    for (std::size_t i = 1; i < rest.size(); ++i) EXPECT_NEAR(norm(found.m_X[i]), norm(rest[i]), 1e-6) << i;
}

TEST(RestPositions, ArePresentOnesAfterRigidMotions)
{
    const TestBox box;
    box.m_body->initializeDmInverse();
    box.m_body->rotate(btQuaternion(btVector3(0, 0, 1), btScalar(1)));
    box.m_body->translate(btVector3(50, 0, 0));
    const RestPositions found = restPositionsOf(*box.m_body, tetsOf(*box.m_body));
    EXPECT_TRUE(found.m_fromMatrices);
    EXPECT_EQ(largestError(found.m_X, relativeToFirst(*box.m_body)), 0);
    EXPECT_EQ(norm(found.m_origin - vec3(box.m_body->m_nodes[0].m_x)), 0);
}

TEST(RestPositions, EachComponentLiesOverItsPresentPlace)
{
    const TetMesh cube = makeBox({1, 1, 1}, {1, 1, 1});
    std::vector<Vec3> X = cube.restPositions();
    std::vector<Tet> tets = cube.tets();
    for (const Vec3& x : cube.restPositions()) X.push_back(x + Vec3{3, 0, 0});
    for (Tet t : cube.tets()) tets.push_back({t[0] + 8, t[1] + 8, t[2] + 8, t[3] + 8});
    btSoftBodyWorldInfo info;
    const auto body = makeSoftBody(info, TetMesh(X, tets));
    body->initializeDmInverse();
    for (int i = 8; i < 16; ++i)  // the second component is twice as large, and farther away
        body->m_nodes[i].m_x = btScalar(2) * body->m_nodes[i].m_x + btVector3(0, 0, 5);
    const RestPositions found = restPositionsOf(*body, tetsOf(*body));
    EXPECT_TRUE(found.m_fromMatrices);
    for (int i = 0; i < 16; ++i)
    {
        const Vec3 expected = i < 8 ? X[i] : X[i] + Vec3{3.5, .5, 5.5};  // its centre moved from 3.5 to 7
        EXPECT_LT(norm(found.m_origin + found.m_X[i] - expected), 1e-5) << i;
    }
}

TEST(RestPositions, AreThePresentOnesWithoutMatrices)
{
    const TestBox box;
    const RestPositions found = restPositionsOf(*box.m_body, tetsOf(*box.m_body));
    EXPECT_FALSE(found.m_fromMatrices);
    EXPECT_EQ(largestError(found.m_X, relativeToFirst(*box.m_body)), 0);
}

// Elements of negative orientation have a negative rest volume and the corresponding matrix.
TEST(RestPositions, AreFoundForElementsOfNegativeOrientation)
{
    const TestBox box;
    for (int e = 0; e < box.m_body->m_tetras.size(); e += 2)
        std::swap(box.m_body->m_tetras[e].m_n[0], box.m_body->m_tetras[e].m_n[1]);
    box.m_body->initializeDmInverse();
    const std::vector<Vec3> rest = relativeToFirst(*box.m_body);
    box.m_body->m_nodes[9].m_x += btVector3(btScalar(0.1), 0, 0);
    const RestPositions found = restPositionsOf(*box.m_body, tetsOf(*box.m_body));
    EXPECT_TRUE(found.m_fromMatrices);
    for (std::size_t i = 1; i < rest.size(); ++i) EXPECT_NEAR(norm(found.m_X[i]), norm(rest[i]), 1e-6) << i;
    EXPECT_EQ(restMeshOf(*box.m_body).m_mesh.turnedCount(), (box.m_body->m_tetras.size() + 1) / 2);
}

// Bullet reallocates the nodes when it appends one, and leaves the tetrahedra's pointers dangling.
TEST(RestPositions, RejectElementsWithInvalidNodePointers)
{
    const TestBox box;
    for (int k = 0; k < 40; ++k) box.m_body->appendNode(btVector3(5, 5, 5), 1);
    try
    {
        tetsOf(*box.m_body);
        FAIL() << "no exception";
    }
    catch (const std::invalid_argument& error)
    {
        EXPECT_NE(std::string(error.what()).find("element 0 points to a node"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace bullet_fem
