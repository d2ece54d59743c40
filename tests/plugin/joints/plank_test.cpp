// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A rigid body falls on another one that is anchored between FEM bodies.
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_fem/btFemHelpers.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kPlank = 0.4, kCushion = 0.2, kWidth = 0.8, kThick = 0.12, kCrate = 0.3;  // [m]
constexpr double kPlankMass = 15, kCrateMass = 12;                                         // [kg]

// A plank between two cushions, which are fixed to piers.
class PlankBetweenCushions : public testing::TestWithParam<Coupling>
{
protected:
    PlankBetweenCushions()
    {
        RigidSettings settings;
        for (const int side : {-1, 1})
        {
            settings.m_transform = at(btScalar(side * (kPlank / 2 + kCushion + 0.1)), 0, 0);
            m_piers[(side + 1) / 2] = &addRigidBox(m_world, {0.2, kWidth, kThick}, settings);
        }
        settings.m_mass = btScalar(kPlankMass);
        settings.m_transform = at(0, 0, 0);
        m_plank = &addRigidBox(m_world, {kPlank, kWidth, kThick}, settings);
        for (const int side : {-1, 1}) addCushion(side);
    }

    void addCushion(int side)
    {
        const double x = side * (kPlank + kCushion) / 2;
        btSoftBody* cushion = btFemHelpers::createBox(
            m_world.info(), {btScalar(x), 0, 0}, {btScalar(kCushion / 2), btScalar(kWidth / 2), btScalar(kThick / 2)},
            btScalar(0.1));
        btFemMaterial material = btFemMaterial::rubber();
        material.m_youngModulus = 4e5;
        m_fem.setMaterial(cushion, material);
        for (int i = 0; i < cushion->m_nodes.size(); ++i)
        {
            const double outwards = side * (double(cushion->m_nodes[i].m_x.x()) - x);
            if (outwards > 0.499 * kCushion) cushion->appendAnchor(i, m_piers[(side + 1) / 2], true);
            if (outwards < -0.499 * kCushion) cushion->appendAnchor(i, m_plank, true);
        }
        m_cushions[(side + 1) / 2] = &m_world.addSoft(cushion);
        m_weight += massOf(*cushion) * kGravity;
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world{m_fem, GetParam()};
    btRigidBody *m_piers[2] = {}, *m_plank = nullptr;
    btSoftBody* m_cushions[2] = {};
    double m_weight = (kPlankMass + kCrateMass) * kGravity;  // [N]
};

// Bullet's contact rows move the plank in each sweep, and the anchors' system is solved in between: quantities stored
// from earlier outer iterations belong to another system then.
TEST_P(PlankBetweenCushions, StopsAFastCrateAndCarriesIt)
{
    RigidSettings settings;
    settings.m_mass = btScalar(kCrateMass);
    settings.m_transform = at(0, btScalar(0.1), btScalar((kThick + kCrate) / 2 + 0.8));
    const btRigidBody& crate = addRigidBox(m_world, {kCrate, kCrate, kCrate}, settings);
    double apart = 0, fastest = 0;
    for (int k = 0; k < 240; ++k)
    {
        m_world.step();
        fastest = std::max(fastest, double(m_plank->getLinearVelocity().length()));
        for (const btSoftBody* cushion : m_cushions)
        {
            EXPECT_EQ(m_fem.stepReport(cushion).m_flags & BT_FEM_NOT_CONVERGED, 0) << k;
            for (int a = 0; a < m_fem.anchors(cushion).size(); ++a)
                apart = std::max(apart, double(m_fem.anchors(cushion)[a].m_error));
        }
    }
    EXPECT_LT(apart, 5e-3);
    EXPECT_LT(fastest, 2.5);  // a common velocity after an inelastic impact at 4 m/s is 1.8
    EXPECT_GT(crate.getWorldTransform().getOrigin().z(), kCrate / 2);
    double carried = 0;
    for (const btSoftBody* cushion : m_cushions)
        for (int a = 0; a < m_fem.anchors(cushion).size(); ++a)
            if (m_fem.anchors(cushion)[a].m_object->isStaticObject())
                carried += double(m_fem.anchors(cushion)[a].m_impulse.z()) / kStep;
    EXPECT_NEAR(std::abs(carried), m_weight, 0.02 * m_weight);
}
INSTANTIATE_TEST_SUITE_P(Couplings, PlankBetweenCushions, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return std::string(couplingName(suite.param)); });

}  // namespace
}  // namespace bullet_fem
