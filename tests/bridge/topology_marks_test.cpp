// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/topology_marks.h"

#include <gtest/gtest.h>

#include <utility>

#include "bridge/bridge_test_bodies.h"

namespace bullet_fem
{
namespace
{

constexpr int kTetras = 40;

/// A box of two cells along each axis after its first step: 40 tetrahedra, five a part.
struct MarkedBox : TestBox
{
    MarkedBox() : m_marks(*m_body) { m_body->m_bUpdateRtCst = false; }

    // Swaps two nodes, which reverses the orientation.
    void rejoin(int tetra) { std::swap(m_body->m_tetras[tetra].m_n[1], m_body->m_tetras[tetra].m_n[2]); }

    // Checks parts until a change is detected or all are checked; returns the number of checks that detected nothing.
    int looksInVain()
    {
        int looks = 0;
        while (looks < TopologyMarks::kTurns && m_marks.matchInTurn(*m_body)) ++looks;
        return looks;
    }

    TopologyMarks m_marks;
};

TEST(TopologyMarks, MatchTheBodyAsItWas)
{
    MarkedBox box;
    ASSERT_EQ(box.m_body->m_tetras.size(), kTetras);
    EXPECT_TRUE(box.m_marks.match(*box.m_body));
    EXPECT_EQ(box.looksInVain(), TopologyMarks::kTurns);
}

// For each tetrahedron, in any phase of the checks.
TEST(TopologyMarks, DetectEveryRejoinedTetrahedron)
{
    int before = 0;
    for (int tetra = 0; tetra < kTetras; ++tetra)
    {
        MarkedBox box;
        for (int k = 0; k < tetra % 5; ++k) ASSERT_TRUE(box.m_marks.matchInTurn(*box.m_body));
        box.rejoin(tetra);
        EXPECT_FALSE(box.m_marks.match(*box.m_body)) << tetra;
        const int looks = box.looksInVain();
        EXPECT_LT(looks, TopologyMarks::kTurns) << tetra;
        before += looks > 0;
    }
    EXPECT_GT(before, 0);  // parts are checked in turns
}

TEST(TopologyMarks, DetectBulletsUpdateFlagAtOnce)
{
    for (int tetra = 0; tetra < kTetras; ++tetra)
    {
        MarkedBox box;
        box.rejoin(tetra);
        box.m_body->m_bUpdateRtCst = true;
        EXPECT_FALSE(box.m_marks.matchInTurn(*box.m_body)) << tetra;
    }
}

TEST(TopologyMarks, DetectReallocatedArraysAtOnce)
{
    for (int tetra = 0; tetra < kTetras; ++tetra)
    {
        MarkedBox box;
        box.rejoin(tetra);
        box.m_body->m_tetras.reserve(2 * box.m_body->m_tetras.capacity());
        EXPECT_FALSE(box.m_marks.matchInTurn(*box.m_body)) << tetra;
    }
}

// Node pointers follow the reallocated array, as followNodes makes them.
TEST(TopologyMarks, IgnoreTheAddressesOfArrays)
{
    MarkedBox box;
    btSoftBody& body = *box.m_body;
    const btSoftBody::Node* first = &body.m_nodes[0];
    body.m_nodes.reserve(2 * body.m_nodes.capacity());
    ASSERT_NE(first, &body.m_nodes[0]);
    for (int e = 0; e < body.m_tetras.size(); ++e)
        for (btSoftBody::Node*& node : body.m_tetras[e].m_n) node = &body.m_nodes[static_cast<int>(node - first)];
    body.m_tetras.reserve(2 * body.m_tetras.capacity());
    EXPECT_TRUE(box.m_marks.match(body));
    EXPECT_EQ(box.looksInVain(), TopologyMarks::kTurns);
}

}  // namespace
}  // namespace bullet_fem
