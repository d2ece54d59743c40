// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies cut into fragments.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

#include "plugin/breaking/welded_scene.h"

namespace bullet_fem
{
namespace
{

class FragmentsTest : public testing::Test
{
protected:
    FragmentsTest() { m_info.m_gravity.setZero(); }

    btSoftBody& box(const Vec3& size, const std::array<int, 3>& cells)
    {
        m_body.reset(btFemHelpers::createFromTetMesh(m_info, makeBox(size, cells, {})));
        return *m_body;
    }
    void cut(const std::vector<int>& labels)
    {
        btFemPieces::cut(m_body.get(), labels, m_pieces);
        for (const btFemPiece& piece : m_pieces) m_owner.emplace_back(piece.m_body);
    }
    void cutVoronoi(int cells)
    {
        std::vector<int> labels;
        btFemPieces::voronoiLabels(m_body.get(), cells, 3, labels);
        cut(labels);
    }

    btSoftBodyWorldInfo m_info;
    std::unique_ptr<btSoftBody> m_body;
    std::vector<btFemPiece> m_pieces;
    std::vector<std::unique_ptr<btSoftBody>> m_owner;
};

TEST_F(FragmentsTest, HaveTheMassAndTheMomentaOfTheWhole)
{
    btSoftBody& whole = box({1, 0.8, 0.6}, {5, 4, 3});
    for (int i = 0; i < whole.m_nodes.size(); ++i)
    {
        whole.m_nodes[i].m_v = {btScalar(std::sin(i)), btScalar(std::cos(2 * i)), btScalar(std::sin(3 * i))};
        if (i % 3 == 0) whole.setMass(i, btScalar(1 + 0.1 * (i % 7)));
    }
    const double mass = massOf(whole);
    const Motion before = motionOf(whole);
    cutVoronoi(7);
    ASSERT_EQ(m_pieces.size(), 7u);
    double sum = 0;
    Motion after;
    for (const btFemPiece& piece : m_pieces) sum += massOf(*piece.m_body), after += motionOf(*piece.m_body);
    EXPECT_NEAR(sum, mass, 1e-6 * mass);
    EXPECT_LT(norm(after.m_linear - before.m_linear), 1e-6 * mass);
    EXPECT_LT(norm(after.m_angular - before.m_angular), 1e-6 * mass);
    EXPECT_NEAR(after.m_energy, before.m_energy, 1e-6 * before.m_energy);
}

TEST_F(FragmentsTest, HaveEveryTetrahedronOnceInPlace)
{
    const btSoftBody& whole = box({1, 0.8, 0.6}, {5, 4, 3});
    cutVoronoi(7);
    std::vector<int> times(whole.m_tetras.size(), 0);
    for (const btFemPiece& piece : m_pieces)
    {
        ASSERT_EQ(piece.m_body->m_tetras.size(), static_cast<int>(piece.m_tets.size()));
        ASSERT_EQ(piece.m_body->m_nodes.size(), static_cast<int>(piece.m_nodes.size()));
        for (int e = 0; e < piece.m_body->m_tetras.size(); ++e)
        {
            const int of = piece.m_tets[e];
            ++times[of];
            std::multiset<int> a, b;
            for (int k = 0; k < 4; ++k)
            {
                a.insert(static_cast<int>(whole.m_tetras[of].m_n[k] - &whole.m_nodes[0]));
                b.insert(piece.m_nodes[piece.m_body->m_tetras[e].m_n[k] - &piece.m_body->m_nodes[0]]);
            }
            EXPECT_EQ(a, b);
        }
        for (int i = 0; i < piece.m_body->m_nodes.size(); ++i)
            EXPECT_EQ(piece.m_body->m_nodes[i].m_x, whole.m_nodes[piece.m_nodes[i]].m_x);
    }
    for (int count : times) EXPECT_EQ(count, 1);
}

TEST_F(FragmentsTest, OneLabelInTwoPlacesGivesTwoFragments)
{
    const btSoftBody& whole = box({4, 1, 1}, {4, 1, 1});
    std::vector<int> labels = sliceLabels(makeBox({4, 1, 1}, {4, 1, 1}, {}), 4);
    for (int& label : labels) label = label == 1 ? 1 : label == 3 ? -5 : 0;
    cut(labels);
    std::vector<int> found;
    for (const btFemPiece& piece : m_pieces) found.push_back(piece.m_label);
    EXPECT_EQ(found, (std::vector<int>{-5, 0, 0, 1}));
    EXPECT_EQ(whole.m_tetras.size(), 20);
}

// Strains are kept by cutting.
TEST_F(FragmentsTest, KeepTheRestShapePinsAndSettings)
{
    btSoftBody& whole = box({1, 0.8, 0.6}, {5, 4, 3});
    whole.m_cfg.kDF = btScalar(0.77);
    whole.setFriction(btScalar(0.31));
    whole.setMass(0, 0);
    for (int i = 0; i < whole.m_nodes.size(); ++i) whole.m_nodes[i].m_x *= btVector3(btScalar(1.5), 1, btScalar(0.9));
    cutVoronoi(4);
    int pinned = 0;
    for (const btFemPiece& piece : m_pieces)
    {
        EXPECT_EQ(piece.m_body->m_cfg.kDF, whole.m_cfg.kDF);
        EXPECT_EQ(piece.m_body->getFriction(), whole.getFriction());
        for (int i = 0; i < piece.m_body->m_nodes.size(); ++i) pinned += piece.m_body->m_nodes[i].m_im == 0;
        for (std::size_t e = 0; e < piece.m_tets.size(); ++e)
        {
            const btSoftBody::Tetra &of = whole.m_tetras[piece.m_tets[e]],
                                    &is = piece.m_body->m_tetras[static_cast<int>(e)];
            EXPECT_NEAR(double(is.m_element_measure), double(of.m_element_measure),
                        1e-5 * double(of.m_element_measure));
            Mat3 F[2];  // from rest to present, for any order of the nodes
            for (const btSoftBody::Tetra* tet : {&of, &is})
            {
                btMatrix3x3 edges;
                for (int c = 0; c < 3; ++c)
                    for (int r = 0; r < 3; ++r) edges[r][c] = tet->m_n[c + 1]->m_x[r] - tet->m_n[0]->m_x[r];
                edges = edges * tet->m_Dm_inverse;
                for (int c = 0; c < 3; ++c)
                    for (int r = 0; r < 3; ++r) F[tet == &is](r, c) = double(edges[r][c]);
            }
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(F[0](r, c), F[1](r, c), 1e-4);
            EXPECT_NEAR(determinant(F[1]), 1.35, 1e-3);
        }
    }
    EXPECT_GE(pinned, 1);
}

TEST_F(FragmentsTest, VoronoiCellsAreWholeAndReproducible)
{
    const btSoftBody& whole = box({1, 1, 1}, {6, 6, 6});
    std::vector<int> first, again, other;
    btFemPieces::voronoiLabels(&whole, 12, 5, first);
    btFemPieces::voronoiLabels(&whole, 12, 5, again);
    btFemPieces::voronoiLabels(&whole, 12, 6, other);
    EXPECT_EQ(first, again);
    EXPECT_NE(first, other);
    EXPECT_EQ(std::set<int>(first.begin(), first.end()).size(), 12u);
    cut(first);
    EXPECT_EQ(m_pieces.size(), 12u);  // each cell is in one connected part
    std::size_t smallest = first.size();
    for (const btFemPiece& piece : m_pieces) smallest = std::min(smallest, piece.m_tets.size());
    EXPECT_GT(smallest, first.size() / 12 / 5);  // of similar size
}

TEST_F(FragmentsTest, AreRejectedForBadInput)
{
    const btSoftBody& whole = box({1, 1, 1}, {2, 2, 2});
    std::vector<int> labels(40, 0);
    std::string why;
    EXPECT_FALSE(btFemPieces::voronoiLabels(&whole, 0, 1, labels, &why));
    EXPECT_NE(why.find("0 cells"), std::string::npos) << why;
    EXPECT_NE(why.find("[1, 40]"), std::string::npos) << why;
    EXPECT_FALSE(btFemPieces::voronoiLabels(&whole, 41, 1, labels, &why));
    EXPECT_NE(why.find("41 cells"), std::string::npos) << why;
    EXPECT_FALSE(btFemPieces::voronoiLabels(nullptr, 2, 1, labels, &why));
    EXPECT_NE(why.find("null"), std::string::npos) << why;
    EXPECT_THROW(btFemPieces::cut(&whole, std::vector<int>(39), m_pieces), std::invalid_argument);
    EXPECT_FALSE(btFemPieces::cut(&whole, std::vector<int>(39), m_pieces, &why));
    EXPECT_NE(why.find("39 labels for 40"), std::string::npos) << why;
    EXPECT_FALSE(btFemPieces::cut(nullptr, labels, m_pieces, &why));
    const btSoftBody cloth(&m_info);
    EXPECT_FALSE(btFemPieces::cut(&cloth, {}, m_pieces, &why));
    EXPECT_NE(why.find("no tetrahedra"), std::string::npos) << why;
    EXPECT_TRUE(m_pieces.empty());
}

}  // namespace
}  // namespace bullet_fem
