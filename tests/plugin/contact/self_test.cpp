// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

// A strip, 2 x 0.3 x 0.05 m: the half at x < 0.9 is fixed on the floor, the other half is bent upwards and over in an
// arc. It is too soft to stand, and falls onto the first half; below is a plane.
class FoldingStrip
{
public:
    explicit FoldingStrip(bool selfContact) : m_world(m_fem)
    {
        m_world.addPlane();
        const TetMesh mesh = makeBox({2, 0.3, 0.05}, {30, 3, 1});
        m_strip = btFemHelpers::createFromTetMesh(m_world.info(), mesh);
        btFemMaterial material;
        material.m_youngModulus = btScalar(5e4);
        m_fem.setMaterial(m_strip, material);
        if (selfContact) m_strip->m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
        m_world.addSoft(m_strip);
        m_fem.prepare(m_strip, kStep);
        m_rest = mesh.restPositions();
        for (int i = 0; i < m_strip->m_nodes.size(); ++i)
        {
            const Vec3& X = m_rest[i];
            if (X.x < 0.9) m_strip->setMass(i, X.z < 0.01 ? 0 : 1 / m_strip->m_nodes[i].m_im);
            if (X.x < 1) continue;
            const double r = 0.15, roof = r - (X.z - 0.05), angle = std::min((X.x - 1) / r, 3.14159265);
            const double beyond = std::max(0.0, X.x - 1 - 3.14159265 * r);
            m_strip->m_nodes[i].m_x =
                bulletVector(Vec3{1 + roof * std::sin(angle) - beyond, X.y, 0.05 + r - roof * std::cos(angle)});
        }
    }

    // Height of the lowest node of the second half above the first half's upper face [m].
    double clearance() const
    {
        double least = 1;
        for (int i = 0; i < m_strip->m_nodes.size(); ++i)
            if (m_rest[i].x > 1.5 && m_strip->m_nodes[i].m_x.x() < btScalar(0.85))
                least = std::min(least, double(m_strip->m_nodes[i].m_x.z()) - 0.05);
        return least;
    }

    int selfContacts() const
    {
        int count = 0;
        for (int k = 0; k < m_fem.contacts(m_strip).size(); ++k) count += m_fem.contacts(m_strip)[k].m_other == m_strip;
        return count;
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btSoftBody* m_strip;
    std::vector<Vec3> m_rest;
};

TEST(SelfContact, AFoldingStripDoesNotPassThroughItself)
{
    FoldingStrip strip(true);
    double least = 1;
    for (int k = 0; k < 120; ++k)
    {
        strip.m_world.step();
        ASSERT_TRUE(allFinite(*strip.m_strip));
        least = std::min(least, strip.clearance());
    }
    EXPECT_GT(least, -0.01) << "compression of the fixed half";
    EXPECT_LT(strip.clearance(), 0.01) << "it lies on it";
    EXPECT_GT(strip.selfContacts(), 10);
}

TEST(SelfContact, IsOffUnlessAskedFor)
{
    FoldingStrip strip(false);
    strip.m_world.step(40);
    EXPECT_LT(strip.clearance(), -0.05) << "it fell through";
    EXPECT_EQ(strip.selfContacts(), 0);
}

TEST(SelfContact, IsTheSameIfItIsAskedForLater)
{
    FoldingStrip early(true), late(false);
    late.m_strip->m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;  // already prepared
    early.m_world.step(60);
    late.m_world.step(60);
    EXPECT_GT(late.selfContacts(), 10);
    EXPECT_EQ(bitsOf(*late.m_strip), bitsOf(*early.m_strip));
}

TEST(SelfContact, GoesOnWithAnotherRestShape)
{
    FoldingStrip strip(true);
    strip.m_world.step(60);
    const int before = strip.selfContacts();
    strip.m_strip->scale(btVector3(btScalar(1.001), 1, 1));
    strip.m_world.step(10);
    EXPECT_TRUE(allFinite(*strip.m_strip));
    EXPECT_GT(strip.selfContacts(), before / 2);
}

// Enabling self contact does not change a body without self contact.
TEST(SelfContact, DoesNotDisturbASquashedBody)
{
    const auto run = [](bool selfContact)
    {
        btFemSoftBodySolver fem;
        SoftWorld world(fem);
        world.addPlane();
        SoftBox box;
        box.m_size = {1, 1, 0.5};
        box.m_cells = {6, 6, 3};
        box.m_center = {0.5, 0.5, 1.25};
        box.m_youngModulus = btScalar(3e4);
        box.m_friction = btScalar(0.2);
        btSoftBody& cube = addSoftBox(world, fem, box);
        if (selfContact) cube.m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
        world.step(90);
        return bitsOf(cube);
    };
    EXPECT_EQ(run(true), run(false));
}

}  // namespace
}  // namespace bullet_fem
