// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "bullet_bridge/body/soft_body_mesh.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/snapshot_scene.h"
#include "plugin/snapshot/btFemEnvelope.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;
using Bytes = std::vector<unsigned char>;

int indexOf(const btSoftBody& body, const btSoftBody::Node* node)
{
    return static_cast<int>(node - &body.m_nodes[0]);
}

/// A copy by other means: positions, velocities, elements, faces and m_cfg.
btSoftBody* copyOf(const btSoftBody& body, btSoftBodyWorldInfo& info)
{
    std::vector<btVector3> positions;
    for (int i = 0; i < body.m_nodes.size(); ++i) positions.push_back(body.m_nodes[i].m_x);
    auto* copy = new btSoftBody(&info, body.m_nodes.size(), positions.data(), nullptr);
    for (int i = 0; i < body.m_nodes.size(); ++i) copy->m_nodes[i].m_v = body.m_nodes[i].m_v;
    for (int e = 0; e < body.m_tetras.size(); ++e)
    {
        const auto node = [&](int a) { return indexOf(body, body.m_tetras[e].m_n[a]); };
        copy->appendTetra(node(0), node(1), node(2), node(3));
    }
    for (int f = 0; f < body.m_faces.size(); ++f)
    {
        const auto node = [&](int a) { return indexOf(body, body.m_faces[f].m_n[a]); };
        copy->appendFace(node(0), node(1), node(2));
    }
    copy->m_cfg = body.m_cfg;
    return copy;
}

/// A beam at rest, fixed at one end and bent by its weight.
class Definition : public EachWorld
{
protected:
    Definition()
    {
        SoftBox box{{1.6, 0.4, 0.4}, {8, 2, 2}, {0, 0, 3}, btScalar(4e5)};
        m_beam = &m_scene.add(box);
        btFemMaterial material;
        material.m_youngModulus = box.m_youngModulus;
        material.m_massDamping = 4;
        material.m_meanDilatation = btFemMeanDilatation::on;
        material.m_bending = btFemBending::plain;
        m_scene.m_fem.setMaterial(m_beam, material);
        for (int i = 0; i < m_beam->m_nodes.size(); ++i)
            if (m_beam->m_nodes[i].m_x.x() < btScalar(-0.79)) m_beam->setMass(i, 0);
        m_scene.m_fem.setContactOffset(m_beam, btScalar(0.03));
        m_scene.m_fem.setDetail(m_beam, btFemDetail::globalWarp);
        m_scene.m_world.step(400);
        m_scene.m_fem.saveDefinition(m_beam, m_saved);
    }

    static double tip(const btSoftBody& body) { return double(body.m_nodes[body.m_nodes.size() - 1].m_x.z()); }

    /// Expects that the definition is refused with this reason, and that the body is unchanged.
    void expectRefused(btSoftBody& body, const Bytes& bytes, const std::string& reason)
    {
        Bytes before, after;
        m_scene.m_fem.saveDefinition(&body, before);
        std::string why;
        EXPECT_FALSE(m_scene.m_fem.applyDefinition(&body, bytes.data(), bytes.size(), &why)) << reason;
        EXPECT_THAT(why, HasSubstr(reason));
        EXPECT_THROW(m_scene.m_fem.applyDefinition(&body, bytes.data(), bytes.size()), std::invalid_argument);
        m_scene.m_fem.saveDefinition(&body, after);
        EXPECT_TRUE(after == before) << reason;
        EXPECT_TRUE(m_scene.m_fem.isFem(&body));
    }

    SnapshotScene m_scene{Coupling::swap, {}, GetParam()};
    btSoftBody* m_beam;
    Bytes m_saved;
    const double m_straight = 3.2;  ///< height of the tip at rest without weight [m]
};

INSTANTIATE_TEST_SUITE_P(Worlds, Definition, eachWorld(), nameOfWorld);

TEST_P(Definition, KeepsTheRestShapeMaterialMassesAndPinsOfABentBody)
{
    const double sag = m_straight - tip(*m_beam);
    ASSERT_GT(sag, 0.05);
    SnapshotScene other{Coupling::swap, {}, GetParam()};
    btSoftBody& copy = other.m_world.addSoft(copyOf(*m_beam, other.m_world.info()));
    other.m_fem.applyDefinition(&copy, m_saved.data(), m_saved.size());
    for (int i = 0; i < copy.m_nodes.size(); ++i) EXPECT_EQ(copy.m_nodes[i].m_im, m_beam->m_nodes[i].m_im);
    other.m_world.step(120);
    // It keeps its shape; the remaining motion is that of a beam nearly at rest.
    EXPECT_NEAR(tip(copy), tip(*m_beam), 0.01 * sag);
    EXPECT_EQ(other.m_fem.stepReport(&copy).m_detail, btFemDetail::globalWarp);

    // Without it the bent shape is the rest shape, and the beam sags further by an equal amount.
    btSoftBody& lost = other.m_world.addSoft(copyOf(*m_beam, other.m_world.info()));
    for (int i = 0; i < lost.m_nodes.size(); ++i) lost.m_nodes[i].m_im = m_beam->m_nodes[i].m_im;
    btFemMaterial material;
    material.m_youngModulus = btScalar(4e5);
    material.m_density = 0;
    material.m_massDamping = 4;
    material.m_bending = btFemBending::plain;
    other.m_fem.setMaterial(&lost, material);
    other.m_world.step(300);
    EXPECT_LT(tip(lost), tip(*m_beam) - 0.5 * sag);
}

TEST_P(Definition, IsTheSameForTheReceivingBody)
{
    SnapshotScene other{Coupling::swap, {}, GetParam()};
    btSoftBody& copy = other.m_world.addSoft(copyOf(*m_beam, other.m_world.info()));
    other.m_fem.applyDefinition(&copy, m_saved.data(), m_saved.size());
    Bytes again;
    other.m_fem.saveDefinition(&copy, again);
    EXPECT_TRUE(again == m_saved);
    other.m_world.step(2);
    ASSERT_TRUE(other.m_fem.isFem(&copy));
    other.m_fem.saveDefinition(&copy, again);
    EXPECT_TRUE(again == m_saved);
}

// Not with the rest shape and masses of fewer nodes.
TEST_P(Definition, IsForgottenIfCutBeforeTheFirstStep)
{
    SnapshotScene other{Coupling::swap, {}, GetParam()};
    btSoftBody& copy = other.m_world.addSoft(copyOf(*m_beam, other.m_world.info()));
    other.m_fem.applyDefinition(&copy, m_saved.data(), m_saved.size());
    std::vector<int> corners;  // Bullet's appendNode reallocates the nodes
    for (int e = 0; e < copy.m_tetras.size(); ++e)
        for (const btSoftBody::Node* node : copy.m_tetras[e].m_n) corners.push_back(indexOf(copy, node));
    copy.appendNode(copy.m_nodes[0].m_x + btVector3(btScalar(-0.2), 0, 0), 1);
    for (std::size_t k = 0; k < corners.size(); ++k)
        copy.m_tetras[static_cast<int>(k / 4)].m_n[k % 4] = &copy.m_nodes[corners[k]];
    copy.appendTetra(copy.m_nodes.size() - 1, corners[0], corners[1], corners[2]);
    Bytes ofCut;
    other.m_fem.saveDefinition(&copy, ofCut);
    EXPECT_GT(ofCut.size(), m_saved.size());
    other.m_world.step();
    if (GetParam() != WorldClass::deformable)  // a deformable world sets it up before the step, without a report
    {
        EXPECT_TRUE(other.m_fem.stepReport(&copy).m_flags & BT_FEM_CHANGED_MESH);
    }
    EXPECT_TRUE(allFinite(copy));
    ASSERT_TRUE(other.m_fem.isFem(&copy));
    EXPECT_EQ(other.m_fem.stepReport(&copy).m_nodes, m_beam->m_nodes.size() + 1);
}

TEST_P(Definition, ContinuesBitForBitWithASavedState)
{
    const Bytes state = m_scene.save();
    SnapshotScene other{Coupling::swap, {}, GetParam()};
    btSoftBody& copy = other.m_world.addSoft(copyOf(*m_beam, other.m_world.info()));
    other.m_soft.push_back(&copy);
    other.m_fem.applyDefinition(&copy, m_saved.data(), m_saved.size());
    other.m_fem.prepare(&copy, kStep);
    other.m_fem.restoreState(state.data(), state.size());
    EXPECT_TRUE(other.save() == state);
    EXPECT_TRUE(other.run(100) == m_scene.run(100));
}

TEST_P(Definition, KeepsTheFilledFractionsOfACage)
{
    btSoftBody& cage = m_scene.add({{0.5, 0.5, 0.5}, {2, 2, 2}, {3, 0, 1}});
    for (int e = 0; e < cage.m_tetras.size(); e += 2) storeFill(cage, e, 0.5, 1.25);
    m_scene.m_world.step();
    Bytes bytes;
    m_scene.m_fem.saveDefinition(&cage, bytes);
    SnapshotScene other{Coupling::swap, {}, GetParam()};
    btSoftBody& copy = other.m_world.addSoft(copyOf(cage, other.m_world.info()));
    other.m_fem.applyDefinition(&copy, bytes.data(), bytes.size());
    EXPECT_EQ(filledFractionsOf(copy), filledFractionsOf(cage));
    EXPECT_EQ(massScaleOf(copy), 1.25);
}

TEST_P(Definition, IsRefusedByOtherBodies)
{
    btSoftBody& box = m_scene.add({{0.5, 0.5, 0.5}, {2, 2, 2}, {3, 0, 1}});
    m_scene.m_world.step();
    expectRefused(box, m_saved, "it has 81 nodes and 160 tetrahedra, and the body 27 and 40");
    Bytes swapped;
    m_scene.m_fem.saveDefinition(&box, swapped);
    btSoftBody& turned = m_scene.m_world.addSoft(copyOf(box, m_scene.m_world.info()));
    std::swap(turned.m_tetras[0].m_n[0], turned.m_tetras[0].m_n[1]);
    m_scene.m_world.step();
    expectRefused(turned, swapped, "join other nodes");
    std::string why;
    EXPECT_FALSE(m_scene.m_fem.applyDefinition(nullptr, swapped.data(), swapped.size(), &why));
}

TEST_P(Definition, IsRefusedIfDamaged)
{
    expectRefused(*m_beam, {}, "header");
    expectRefused(*m_beam, m_scene.save(), "not a body's definition");
    expectRefused(*m_beam, Bytes(m_saved.begin(), m_saved.end() - 1), "cut off");
    std::mt19937 random(1);
    std::string why;
    for (int k = 0; k < 1000; ++k)
    {
        Bytes bytes = m_saved;
        bytes[random() % bytes.size()] ^= static_cast<unsigned char>(1u << random() % 8);
        EXPECT_FALSE(m_scene.m_fem.applyDefinition(m_beam, bytes.data(), bytes.size(), &why));
    }
}

TEST_P(Definition, MutatedBytesAreRejectedOrMove)
{
    std::mt19937 random(3);
    std::string why;
    int refused = 0;
    for (int k = 0; k < 2000; ++k)
    {
        Bytes bytes = m_saved;
        const std::size_t at = 40 + random() % (bytes.size() - 48);
        if (k % 2 == 0)
            bytes[at] = static_cast<unsigned char>(random());
        else
            bytes.erase(bytes.begin() + at, bytes.begin() + at + 1 + random() % 8);
        closeEnvelope(bytes);
        const bool taken = m_scene.m_fem.applyDefinition(m_beam, bytes.data(), bytes.size(), &why);
        refused += taken ? 0 : 1;
        if (k % 50 == 0) m_scene.m_world.step(2);
        ASSERT_TRUE(allFinite(*m_beam)) << "mutation " << k;
    }
    EXPECT_GT(refused, 1000);
}

TEST_P(Definition, CannotBeSavedForANullBody)
{
    Bytes bytes(10, 1);
    std::string why;
    EXPECT_FALSE(m_scene.m_fem.saveDefinition(nullptr, bytes, &why));
    EXPECT_THAT(why, HasSubstr("null"));
    EXPECT_TRUE(bytes.empty());
    EXPECT_THROW(m_scene.m_fem.saveDefinition(nullptr, bytes), std::invalid_argument);
}

}  // namespace
}  // namespace bullet_fem
