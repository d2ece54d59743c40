// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Stiff slender beams on anchors or pins, under loads of contact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "plugin/scenes/kinematic_bodies.h"
#include "plugin/scenes/scene_measures.h"

namespace bullet_fem
{
namespace
{

enum class BeamLoad
{
    ball,    // of half the beam's mass, falls on the middle from .01 of the half length
    box,     // of half the beam's mass, beside the middle
    pressed  // a kinematic box that presses the middle down by .015 of the half length
};

struct BeamCase
{
    double m_half;  // half length [m]
    int m_ends;     // that are held
    BeamLoad m_load;
};

// Coupling, beam, E [Pa], step [s].
class AnchoredBeam : public testing::TestWithParam<std::tuple<Coupling, BeamCase, double, double>>
{
protected:
    struct Result
    {
        double m_fastest = 0, m_atRest = 0;  // since the start, and in the last second of four [m/s]
        double m_flagged = 0;                // share of the steps with BT_FEM_ENERGY [-]
    };

    // `harder`: factor on E [-].
    static Result run(bool isPinned, double harder = 1)
    {
        const auto& [coupling, beam, young, h] = GetParam();
        const double s = beam.m_half;
        FemWorld world(WorldClass::softRigid, coupling);
        SoftBox box;
        box.m_size = s * Vec3{2, 0.1, 0.1};
        box.m_cells = {20, 1, 1};
        box.m_youngModulus = btScalar(harder * young);
        box.m_bending = btFemBending::plain;  // the softest beams would droop, and swing until the end
        btSoftBody& body = addSoftBox(world, world.fem(), box);
        world.fem().prepare(&body, btScalar(h));
        hold(world, body, isPinned);
        btRigidBody* jaw = load(world, massOf(body));
        Result result;
        int steps = 0;
        for (int k = 1; k * h <= 4; ++k, ++steps)
        {
            if (jaw)
                jaw->getMotionState()->setWorldTransform(at(0, 0, btScalar(s * (0.155 - 0.02 * std::min(1.0, k * h)))));
            world.step(1, btScalar(h));
            const double speed = fastestNode(body);
            result.m_fastest = std::max(result.m_fastest, speed);
            if (world.fem().stepReport(&body).m_flags & BT_FEM_ENERGY) ++result.m_flagged;
            if (k * h > 3) result.m_atRest = std::max(result.m_atRest, speed);
            if (!(speed < 1e3)) break;
        }
        result.m_flagged /= steps;
        return result;
    }

private:
    // Holds the end faces by anchors to static boxes, or by pins.
    static void hold(FemWorld& world, btSoftBody& body, bool isPinned)
    {
        const BeamCase& beam = std::get<1>(GetParam());
        for (int end = 0; end < beam.m_ends; ++end)
        {
            const double side = end == 0 ? -1 : 1, s = beam.m_half;
            RigidSettings settings;
            settings.m_transform = at(btScalar(side * 1.1 * s), 0, 0);
            btRigidBody& block = addRigidBox(world, s * Vec3{0.2, 0.2, 0.2}, settings);
            for (int i = 0; i < body.m_nodes.size(); ++i)
            {
                if (std::fabs(double(body.m_nodes[i].m_x.x()) - side * s) > 1e-4 * s) continue;
                if (isPinned)
                    body.setMass(i, 0);
                else
                    body.appendAnchor(i, &block, true, 1);
            }
        }
    }

    // Returns the kinematic box, or null.
    static btRigidBody* load(FemWorld& world, double mass)
    {
        const BeamCase& beam = std::get<1>(GetParam());
        const double s = beam.m_half;
        RigidSettings settings;
        settings.m_mass = btScalar(0.5 * mass);
        if (beam.m_load == BeamLoad::pressed)
            return &addKinematicBox(world, s * Vec3{0.2, 0.2, 0.2}, at(0, 0, btScalar(0.155 * s)));
        if (beam.m_load == BeamLoad::ball)
        {
            settings.m_transform = at(0, 0, btScalar(0.21 * s));
            world.addRigid(new btSphereShape(btScalar(0.15 * s)), settings);
        }
        else
        {
            settings.m_transform = at(btScalar(-0.5 * s), 0, btScalar(0.16 * s));
            addRigidBox(world, s * Vec3{0.2, 0.2, 0.2}, settings);
        }
        return nullptr;
    }
};

// Under the loads soft beams sag and swing, on pins as on anchors; stiff ones come to rest. Pressed ones
// may shake.
TEST_P(AnchoredBeam, IsNoFasterThanOnPins)
{
    const Result anchored = run(false), pinned = run(true);
    RecordProperty("speed", std::to_string(anchored.m_fastest) + " pinned " + std::to_string(pinned.m_fastest) +
                                " rest " + std::to_string(anchored.m_atRest) + " pinned " +
                                std::to_string(pinned.m_atRest));
    const bool isPressed = std::get<1>(GetParam()).m_load == BeamLoad::pressed;
    EXPECT_LT(anchored.m_fastest, 1.05 * pinned.m_fastest + (isPressed ? 0.5 : 0.2));
    EXPECT_LT(anchored.m_atRest, 1.2 * pinned.m_atRest + (isPressed ? 0.2 : 0.02));
}

using HardPressedBeam = AnchoredBeam;

// Steps of this motion would create energy (BT_FEM_ENERGY): without the limit they threw nodes at 1,200 to 2,300 m/s,
// and with the compliance of the factor at rest still one beam in six. It shakes at up to 2 m/s, by chance.
TEST_P(HardPressedBeam, IsNotThrown)
{
    constexpr int kBeams = 6;
    const bool isHeldTwice = std::get<1>(GetParam()).m_ends == 2;
    double flagged = 0;
    int thrown = 0;
    for (int k = 0; k < kBeams; ++k)
    {
        const Result anchored = run(false, 1 + 1e-3 * k);
        flagged += anchored.m_flagged / kBeams;
        if (anchored.m_fastest > 3) ++thrown;
    }
    RecordProperty("thrown", std::to_string(thrown) + " flagged " + std::to_string(flagged));
    EXPECT_LE(thrown, isHeldTwice ? 1 : 0);
    EXPECT_LT(flagged, isHeldTwice ? 0.08 : 0.03);
}

std::string nameOfBeam(const testing::TestParamInfo<AnchoredBeam::ParamType>& suite)
{
    const BeamCase& beam = std::get<1>(suite.param);
    return std::string(couplingName(std::get<0>(suite.param))) + (beam.m_half < 0.5 ? "_Small" : "_Large") +
           (beam.m_ends == 1 ? "OneEnd" : "TwoEnds") +
           (beam.m_load == BeamLoad::ball  ? "Ball"
            : beam.m_load == BeamLoad::box ? "Box"
                                           : "Pressed") +
           "_" + nameOfYoung(std::get<2>(suite.param)) + "_" + nameOfStep(std::get<3>(suite.param));
}

INSTANTIATE_TEST_SUITE_P(
    Loaded, AnchoredBeam,
    testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                     testing::Values(BeamCase{1, 2, BeamLoad::ball}, BeamCase{1, 2, BeamLoad::box},
                                     BeamCase{1, 1, BeamLoad::ball}, BeamCase{0.1, 2, BeamLoad::ball},
                                     BeamCase{0.1, 2, BeamLoad::box}, BeamCase{0.1, 1, BeamLoad::ball}),
                     testing::Values(1e6, 1e7, 1e8, 1e9), testing::Values(1.0 / 60, 1.0 / 240)),
    nameOfBeam);
INSTANTIATE_TEST_SUITE_P(Pressed, AnchoredBeam,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(BeamCase{1, 2, BeamLoad::pressed},
                                                          BeamCase{0.1, 2, BeamLoad::pressed}),
                                          testing::Values(1e6, 1e7), testing::Values(1.0 / 60, 1.0 / 240)),
                         nameOfBeam);

INSTANTIATE_TEST_SUITE_P(Pressed, HardPressedBeam,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(BeamCase{0.1, 1, BeamLoad::pressed},
                                                          BeamCase{0.1, 2, BeamLoad::pressed}),
                                          testing::Values(1e8, 1e9), testing::Values(1.0 / 60)),
                         nameOfBeam);

}  // namespace
}  // namespace bullet_fem
