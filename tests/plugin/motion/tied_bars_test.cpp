// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Chains of bars that swing on joints with little contact damping.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemWelds.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

enum class TopJoint
{
    anchor,
    pin
};

enum class BarJoint
{
    attachment,  // nodes on an edge
    weld         // all nodes of a face
};

struct TiedBarsCase
{
    Coupling m_coupling;
    int m_bars;
    TopJoint m_top;
    BarJoint m_between;
    double m_youngModulus, m_stiffnessDamping, m_contactDamping;  // [Pa], [s], [-]
    double m_rate = 60;                                           // steps per second [Hz]
};

std::string nameOfBars(const testing::TestParamInfo<TiedBarsCase>& suite)
{
    const TiedBarsCase& p = suite.param;
    return couplingName(p.m_coupling) + std::to_string(p.m_bars) + (p.m_top == TopJoint::pin ? "Pinned" : "Anchored") +
           (p.m_between == BarJoint::weld ? "Welded" : "Attached") + std::to_string(int(p.m_youngModulus / 1e6)) +
           "MPa" + (p.m_stiffnessDamping > 0 ? "Viscous" : "") + std::to_string(int(100 * p.m_contactDamping)) + "At" +
           std::to_string(int(p.m_rate)) + "Hz";
}

// Bars of half a metre, which hang end to end from a static box and start to swing about their top.
class TiedBars : public testing::TestWithParam<TiedBarsCase>
{
protected:
    static constexpr double kLength = 0.5, kWidth = 0.05;  // of a bar [m]
    static constexpr double kSpin = 0.38;                  // [rad/s]

    TiedBars() : m_world(WorldClass::softRigid, GetParam().m_coupling, {0, 0, btScalar(-kGravity)}, damped())
    {
        const TiedBarsCase& p = GetParam();
        RigidSettings settings;
        settings.m_transform = at(0, 0, btScalar(0.3));
        btRigidBody& top = m_world.addRigid(new btBoxShape(btVector3(1, 1, 1) * btScalar(0.1)), settings);
        for (int k = 0; k < p.m_bars; ++k) m_bars.push_back(&addBar(k));
        for (const int i : edgeOf(*m_bars[0], 0))
            if (p.m_top == TopJoint::pin)
                m_bars[0]->setMass(i, 0);
            else
                m_bars[0]->appendAnchor(i, &top, true);
        for (btSoftBody* bar : m_bars) m_world.fem().prepare(bar, step());
        for (int k = 0; k + 1 < p.m_bars; ++k) join(k);
        for (btSoftBody* bar : m_bars)
            for (int i = 0; i < bar->m_nodes.size(); ++i)
                if (bar->m_nodes[i].m_im > 0)
                    bar->m_nodes[i].m_v = btVector3(0, btScalar(kSpin), 0).cross(bar->m_nodes[i].m_x);
    }

    // Kinetic, potential and elastic energy [J].
    double energy() const
    {
        double sum = 0;
        for (const btSoftBody* bar : m_bars)
            sum += motionOf(*bar).m_energy + massOf(*bar) * kGravity * centerOf(*bar).z + elasticEnergyOf(*bar);
        return sum;
    }

    double kineticEnergy() const
    {
        double sum = 0;
        for (const btSoftBody* bar : m_bars) sum += motionOf(*bar).m_energy;
        return sum;
    }

    double largestError() const
    {
        double largest = 0;
        for (const btSoftBody* bar : m_bars)
        {
            const auto& joints = m_world.fem().anchors(bar);
            for (int k = 0; k < joints.size(); ++k) largest = std::max(largest, double(joints[k].m_error));
        }
        return largest;
    }

    btScalar step() const { return btScalar(1 / GetParam().m_rate); }

    FemWorld m_world;

private:
    static btFemSolverInfo damped()
    {
        btFemSolverInfo info;
        info.m_contactDamping = btScalar(GetParam().m_contactDamping);
        return info;
    }

    btSoftBody& addBar(int k)
    {
        btSoftBody& bar = *btFemHelpers::createFromTetMesh(m_world.info(), m_mesh);
        bar.translate({0, 0, btScalar(-k * kLength)});
        btFemMaterial material;
        material.m_youngModulus = btScalar(GetParam().m_youngModulus);
        material.m_stiffnessDamping = btScalar(GetParam().m_stiffnessDamping);
        material.m_massDamping = 0;
        material.m_bending = btFemBending::plain;
        m_world.fem().setMaterial(&bar, material);
        bar.m_cfg.collisions = 0;
        return m_world.addSoft(&bar);
    }

    // Nodes at x = 0 and this height.
    static std::vector<int> edgeOf(const btSoftBody& bar, double z)
    {
        std::vector<int> nodes;
        for (int i = 0; i < bar.m_nodes.size(); ++i)
        {
            const btVector3& x = bar.m_nodes[i].m_x;
            if (std::fabs(x.x()) < 1e-5 && std::fabs(x.z() - z) < 1e-5) nodes.push_back(i);
        }
        return nodes;
    }

    void join(int k)
    {
        btSoftBody &upper = *m_bars[k], &lower = *m_bars[k + 1];
        if (GetParam().m_between == BarJoint::weld)
        {
            btFemWelds::weld(m_world.fem(), &upper, &lower, btFemWeldStrength());
            return;
        }
        const double z = -(k + 1) * kLength;
        for (const int i : edgeOf(upper, z))
            for (const int j : edgeOf(lower, z))
                if ((upper.m_nodes[i].m_x - lower.m_nodes[j].m_x).length() < 1e-5)
                    m_world.fem().attachNodes(&upper, i, &lower, j);
    }

    // sigma : epsilon / 2 by Hooke's law.
    double elasticEnergyOf(const btSoftBody& bar) const
    {
        btAlignedObjectArray<btFemStress> stress;
        m_world.fem().getStress(&bar, stress);
        const double poisson = btFemMaterial().m_poissonRatio;
        double sum = 0;
        for (int e = 0; e < stress.size(); ++e)
        {
            const btFemStress& s = stress[e];
            const double squares = double(s.m_xx) * s.m_xx + double(s.m_yy) * s.m_yy + double(s.m_zz) * s.m_zz +
                                   2 * (double(s.m_xy) * s.m_xy + double(s.m_yz) * s.m_yz + double(s.m_xz) * s.m_xz);
            const double trace = double(s.m_xx) + s.m_yy + s.m_zz;
            sum += m_mesh.tetVolume(e) * ((1 + poisson) * squares - poisson * trace * trace);
        }
        return sum / (2 * GetParam().m_youngModulus);
    }

    const TetMesh m_mesh = makeBox({kWidth, kWidth, kLength}, {2, 2, 10}, {-kWidth / 2, -kWidth / 2, -kLength});
    std::vector<btSoftBody*> m_bars;
};

// To 1 %, a share of the elastic energy: in second-order steps that of a mode of k = (omega h)^2 is 1 to 1 + k / 8
// times a constant.
TEST_P(TiedBars, KeepTheirEnergy)
{
    const TiedBarsCase& p = GetParam();
    const double start = kineticEnergy(), rest = energy() - start;
    const int steps = int(std::lround(20 * p.m_rate));
    for (int k = 0; k < steps; ++k)
    {
        m_world.step(1, step());
        ASSERT_LE(energy() - rest, 1.01 * start) << "step " << k;
        ASSERT_LT(largestError(), 1e-4) << "step " << k;
    }
    EXPECT_GT(energy() - rest, 0.2 * start);
}

constexpr Coupling kSwap = Coupling::swap, kCoupled = Coupling::coupled;
constexpr TopJoint kAnchor = TopJoint::anchor, kPin = TopJoint::pin;
constexpr BarJoint kAttached = BarJoint::attachment, kWelded = BarJoint::weld;

INSTANTIATE_TEST_SUITE_P(, TiedBars,
                         testing::Values(TiedBarsCase{kCoupled, 2, kAnchor, kAttached, 1e7, 0, 0},
                                         TiedBarsCase{kSwap, 2, kAnchor, kAttached, 1e7, 0, 0},
                                         TiedBarsCase{kCoupled, 1, kAnchor, kAttached, 1e6, 0, 0},
                                         TiedBarsCase{kCoupled, 2, kAnchor, kAttached, 1e6, 0, 0},
                                         TiedBarsCase{kCoupled, 2, kAnchor, kAttached, 1e7, 0.005, 0},
                                         TiedBarsCase{kCoupled, 2, kPin, kAttached, 1e7, 0, 0},
                                         TiedBarsCase{kCoupled, 2, kAnchor, kAttached, 1e7, 0, 0.1},
                                         TiedBarsCase{kCoupled, 2, kPin, kWelded, 1e6, 0.005, 0.5},
                                         TiedBarsCase{kSwap, 4, kAnchor, kAttached, 1e7, 0, 0},
                                         TiedBarsCase{kCoupled, 4, kAnchor, kWelded, 1e6, 0, 0},
                                         TiedBarsCase{kCoupled, 2, kAnchor, kAttached, 1e7, 0, 0, 240}),
                         nameOfBars);

}  // namespace
}  // namespace bullet_fem
