// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Baked bodies are bitwise equal to bodies that are not baked (docs/baked.md, Promises, Same motion).
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <tuple>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/baked_bodies.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

constexpr int kStepsOfTwins = 240;

enum class TwinMesh
{
    box,
    cage
};

/// Two worlds with a ground; the soft bodies of one of them were baked.
class BakedTwins : public testing::TestWithParam<std::tuple<Coupling, TwinMesh>>
{
protected:
    using Change = std::function<void(FemWorld& world, btSoftBody& body)>;

    BakedTwins()
    {
        m_settings.m_material = {3e5, 0.37, 900, 0.01, 0.003};
        m_settings.m_singlePrecision = kSingle;
        m_settings.m_step = static_cast<double>(kStep);
        for (FemWorld* world : {&m_bakedWorld, &m_plainWorld}) world->addPlane();
    }

    /// Adds a body at `height` [m] off the world's origin to both worlds, after `change` is applied to it.
    void add(double height, const Change& change = {})
    {
        btSoftBody *baked = nullptr, *plain = nullptr;
        if (std::get<1>(GetParam()) == TwinMesh::box)
        {
            const TetMesh box = makeBox({0.6, 0.5, 0.4}, {4, 4, 3}, {0.1, -0.7, height});
            baked = bake(bakeBody(box, m_settings));
            plain = btFemHelpers::createFromTetMesh(m_plainWorld.info(), box);
        }
        else
        {
            const SurfaceMesh ball = octahedron(0.3, {0, 0, 0.32 + height});
            CageSettings settings;
            settings.m_cellSize = 0.15;
            baked = bake(bakeBody(makeCage(ball, settings), ball, m_settings));
            plain = btFemHelpers::createFromSurface(m_plainWorld.info(), ball, settings);
        }
        for (const int i : m_settings.m_pins) plain->m_nodes[i].m_im = 0;
        m_plainWorld.fem().setMaterial(plain, bulletMaterial(m_settings.m_material));
        if (change) change(m_bakedWorld, *baked);
        if (change) change(m_plainWorld, *plain);
        m_bakedWorld.addSoft(baked);
        m_plainWorld.addSoft(plain);
    }

    void expectSameBits()
    {
        const auto &baked = m_bakedWorld.softBodies(), &plain = m_plainWorld.softBodies();
        bool touched = false;
        for (int k = 0; k < kStepsOfTwins; ++k)
        {
            m_bakedWorld.step(1, btScalar(m_settings.m_step));
            m_plainWorld.step(1, btScalar(m_settings.m_step));
            for (int b = 0; b < baked.size(); ++b)
            {
                touched = touched || m_bakedWorld.fem().contacts(baked[b]).size() > 0;
                ASSERT_EQ(bitsOf(*baked[b]), bitsOf(*plain[b])) << "body " << b << ", step " << k;
                ASSERT_EQ(placesOfDrawn(*baked[b]), placesOfDrawn(*plain[b])) << "body " << b << ", step " << k;
            }
        }
        EXPECT_TRUE(touched);
        for (int b = 0; b < baked.size(); ++b)
        {
            const btFemStepReport report = m_bakedWorld.fem().stepReport(baked[b]);
            EXPECT_TRUE(report.m_bakedFactor);
            EXPECT_EQ(report.m_flags & (BT_FEM_STALE_FACTOR | BT_FEM_REFACTORED | BT_FEM_BAKED_UNUSED), 0);
            EXPECT_FALSE(m_plainWorld.fem().stepReport(plain[b]).m_bakedFactor);
        }
    }

    BakeSettings m_settings;
    FemWorld m_bakedWorld{WorldClass::softRigid, std::get<0>(GetParam())};
    FemWorld m_plainWorld{WorldClass::softRigid, std::get<0>(GetParam())};

private:
    btSoftBody* bake(const BakedBody& made)
    {
        const BakedBody read = throughAFile(made);
        btSoftBody* body = btFemHelpers::createFromBaked(m_bakedWorld.info(), read);
        m_bakedWorld.fem().useBaked(body, read);
        return body;
    }

    static std::vector<btScalar> placesOfDrawn(const btSoftBody& body)
    {
        std::vector<btScalar> places;
        for (int v = 0; v < body.m_renderNodes.size(); ++v)
            for (int c = 0; c < 3; ++c) places.push_back(body.m_renderNodes[v].m_x[c]);
        return places;
    }
};

INSTANTIATE_TEST_SUITE_P(Couplings, BakedTwins,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(TwinMesh::box, TwinMesh::cage)),
                         [](const auto& suite)
                         {
                             return std::string(couplingName(std::get<0>(suite.param))) +
                                    (std::get<1>(suite.param) == TwinMesh::box ? "_box" : "_cage");
                         });

TEST_P(BakedTwins, HaveTheSameBitsWhenTheFirstStepSetsThemUp)
{
    add(0.05);
    expectSameBits();
}

TEST_P(BakedTwins, HaveTheSameBitsWhenPrepared)
{
    add(0.05, [](FemWorld& world, btSoftBody& body) { world.fem().prepare(&body, kStep); });
    expectSameBits();
}

TEST_P(BakedTwins, HaveTheSameBitsWhenPinned)
{
    m_settings.m_pins = {0, 1, 5};
    m_settings.m_material.m_youngModulus = 5e3;  // so that they sag onto the ground
    add(0.05);
    expectSameBits();
}

TEST_P(BakedTwins, HaveTheSameBitsWithTheNeoHookeanLaw)
{
    m_settings.m_material = Material::jelly();
    m_settings.m_material.m_stiffnessDamping = 0.005;
    add(0.05);
    expectSameBits();
}

TEST_P(BakedTwins, HaveTheSameBitsWithMeanDilatationAndAnotherStep)
{
    m_settings.m_material = Material::rubber();
    m_settings.m_material.m_stiffnessDamping = 0.005;
    m_settings.m_step = static_cast<double>(btScalar(0.01));
    add(0.05);
    expectSameBits();
}

TEST_P(BakedTwins, HaveTheSameBitsInSelfContact)
{
    add(0.05, [](FemWorld&, btSoftBody& body) { body.m_cfg.collisions |= btSoftBody::fCollision::CL_SELF; });
    expectSameBits();
}

TEST_P(BakedTwins, HaveTheSameBitsWhenAnchored)
{
    add(0.4,
        [](FemWorld& world, btSoftBody& body)
        {
            RigidSettings settings;
            settings.m_mass = 2;
            settings.m_transform.setOrigin(body.m_nodes[0].m_x - btVector3(0, 0, btScalar(.15)));
            body.appendAnchor(0, &world.addRigid(new btSphereShape(btScalar(.1)), settings), true);
        });
    expectSameBits();
}

TEST_P(BakedTwins, HaveTheSameBitsOnTopOfEachOther)
{
    add(0.05);
    add(0.75);
    expectSameBits();
}

TEST_P(BakedTwins, HaveTheSameBitsWhenMovedAndTurnedOncePrepared)
{
    const btTransform place(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(.7)), {1000, -700, btScalar(.7)});
    add(0.05,
        [&](FemWorld& world, btSoftBody& body)
        {
            world.fem().prepare(&body, kStep);
            body.transform(place);
        });
    expectSameBits();
}

}  // namespace
}  // namespace bullet_fem
