// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A bar without gravity that is turned about its end by led nodes, pins or anchors.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/kinematic_bodies.h"
#include "plugin/scenes/scene_measures.h"

namespace bullet_fem
{
namespace
{

enum class Carrier
{
    targets,  // node targets
    pins,     // pinned nodes, whose positions the program writes
    anchors,  // to a kinematic box
    hinge     // pins on the axis, which stand still
};

const char* nameOfCarrier(Carrier carrier)
{
    const char* names[] = {"Targets", "Pins", "Anchors", "Hinge"};
    return names[static_cast<int>(carrier)];
}

// Carrier, stiffness damping [s], numerical damping [-], step [s].
class LedTurn : public testing::TestWithParam<std::tuple<Carrier, double, double, double>>
{
protected:
    static constexpr double kSpin = 2, kYoung = 1e6, kDensity = 1000;  // [rad/s], [Pa], [kg/m3]

    LedTurn()
    {
        m_bar =
            btFemHelpers::createFromTetMesh(m_world.info(), makeBox({1, 0.08, 0.08}, {10, 2, 2}, {0, -0.04, -0.04}));
        btFemMaterial material;
        material.m_youngModulus = btScalar(kYoung);
        material.m_poissonRatio = 0;
        material.m_density = btScalar(kDensity);
        material.m_stiffnessDamping = btScalar(std::get<1>(GetParam()));
        material.m_bending = btFemBending::plain;  // gives way least beside the hinge, whose stress is singular
        m_world.fem().setMaterial(m_bar, material);
        m_world.addSoft(m_bar);
        const Carrier carrier = std::get<0>(GetParam());
        for (int i = 0; i < m_bar->m_nodes.size(); ++i)
        {
            const btVector3 x = m_bar->m_nodes[i].m_x;
            m_rest.push_back(x);
            m_bar->m_nodes[i].m_v = btVector3(0, 0, btScalar(kSpin)).cross(x);
            const bool isOnAxis = std::fabs(x.y()) < 1e-4;
            if (x.x() < 1e-4 && (carrier != Carrier::hinge || isOnAxis)) m_led.push_back(i);
        }
        for (int i : m_led)
            if (carrier == Carrier::pins || carrier == Carrier::hinge) m_bar->setMass(i, 0);
        m_world.fem().prepare(m_bar, btScalar(std::get<3>(GetParam())));
        if (carrier != Carrier::anchors) return;
        m_carrier = &addKinematicBox(m_world, {0.2, 0.2, 0.2}, boxAt(turnAfter(0)));
        for (int i : m_led) m_bar->appendAnchor(i, m_carrier, true, 1);
    }

    static btQuaternion turnAfter(double time)
    {
        return btQuaternion(btVector3(0, 0, 1), btScalar(std::remainder(kSpin * time, 2 * std::acos(-1.0))));
    }

    static btTransform boxAt(const btQuaternion& turn)
    {
        return btTransform(turn, quatRotate(turn, btVector3(btScalar(-0.1), 0, 0)));
    }

    // Leads the nodes to their poses at this time [s].
    void lead(double time)
    {
        const btQuaternion turn = turnAfter(time);
        const Carrier carrier = std::get<0>(GetParam());
        for (int i : m_led)
        {
            if (carrier == Carrier::targets) m_world.fem().setNodeTarget(m_bar, i, quatRotate(turn, m_rest[i]));
            if (carrier == Carrier::pins) m_bar->m_nodes[i].m_x = quatRotate(turn, m_rest[i]);
        }
        if (m_carrier) m_carrier->getMotionState()->setWorldTransform(boxAt(turn));
    }

    // Distance of the centroid of the outer face from the axis [m].
    double length() const
    {
        Vec3 tip;
        int count = 0;
        for (std::size_t i = 0; i < m_rest.size(); ++i)
        {
            if (m_rest[i].x() < btScalar(0.999)) continue;
            tip += vec3(m_bar->m_nodes[int(i)].m_x);
            ++count;
        }
        return norm(tip) / count;
    }

    static btFemSolverInfo settings()
    {
        btFemSolverInfo info;
        info.m_numericalDamping = btScalar(std::get<2>(GetParam()));
        return info;
    }

    FemWorld m_world{WorldClass::softRigid, settings(), btVector3(0, 0, 0)};
    btSoftBody* m_bar = nullptr;
    btRigidBody* m_carrier = nullptr;
    std::vector<btVector3> m_rest;
    std::vector<int> m_led;
};

// E u'' = -rho w^2 (X + u) with u = 0 at the axis: 1.33 mm. Lumped masses add .5 %, the stress at the hinge 2 %.
TEST_P(LedTurn, StretchesByTheCentrifugalForce)
{
    const double h = std::get<3>(GetParam()), angle = kSpin * std::sqrt(kDensity / kYoung);
    const double expected = std::tan(angle) / angle - 1;
    double stretch = 0;
    int count = 0;
    for (int k = 1; k * h <= 6; ++k)
    {
        lead(k * h);
        m_world.step(1, btScalar(h));
        if (k * h < 3) continue;
        stretch += length() - 1;
        ++count;
    }
    stretch /= count;
    RecordProperty("stretch", std::to_string(stretch / expected));
    EXPECT_NEAR(stretch / expected, 1, 0.03);
}

INSTANTIATE_TEST_SUITE_P(
    Bars, LedTurn,
    testing::Combine(testing::Values(Carrier::targets, Carrier::pins, Carrier::anchors, Carrier::hinge),
                     testing::Values(0.0, 0.005, 0.1), testing::Values(0, 1), testing::Values(1.0 / 60, 1.0 / 240)),
    [](const auto& suite)
    {
        return std::string(nameOfCarrier(std::get<0>(suite.param))) + "_" +
               std::to_string(std::lround(1000 * std::get<1>(suite.param))) + "ms_" +
               (std::get<2>(suite.param) == 1 ? "ImplicitEuler_" : "SecondOrder_") +
               nameOfStep(std::get<3>(suite.param));
    });

}  // namespace
}  // namespace bullet_fem
