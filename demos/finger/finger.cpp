// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Three pneumatic fingers hang from a palm. Air pressure in their bellows bends them around a ball; the palm lifts it.
#include <algorithm>
#include <utility>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr double kCell = 0.005, kDeep = 0.03, kWide = 0.02;   // of the mesh; of a finger along x and z [m]
constexpr int kBellows = 5, kPitch = 5;                       // number and pitch (in cells) of the bellows of a finger
constexpr double kBall = 0.035, kStand = 0.1, kPalm = 0.205;  // radius, heights [m]
constexpr double kApart = 0.04, kLift = 0.1;  // distance of a finger from the centre, stroke of the palm [m]
constexpr double kFill = 0.3, kFull = 1.3, kUp = 1.6, kHigh = 2.6;  // times of inflation and of the palm's lift [s]

/// A finger down from the origin, with its inner side at x = 0 and one cavity: a channel with bellows.
TetMesh fingerMesh()
{
    const int cells = 2 + kBellows * kPitch;
    std::vector<Block> holes = {{{kCell, -(cells - 1) * kCell, -kCell}, {3 * kCell, -2 * kCell, kCell}}};
    for (int k = 0; k < kBellows; ++k)
    {
        const double y = -(2 + k * kPitch) * kCell;
        holes.push_back({{kCell, y - 2 * kCell, -kCell}, {kDeep - kCell, y, kCell}});
        holes.push_back({{4 * kCell, y - 4 * kCell, -1}, {1, y - 3 * kCell, 1}});
    }
    holes.pop_back();
    return carved(makeBox({kDeep, cells * kCell, kWide}, {6, cells, 4}, {0, -cells * kCell, -kWide / 2}), holes);
}

using Finger = std::pair<btSoftBody*, int>;  // with the handle of its chamber

Finger addFinger(DemoWorld& world, btRigidBody& palm, double angle, double young, double friction)
{
    btFemMaterial silicone = btFemMaterial::rubber();
    silicone.m_youngModulus = btScalar(young);
    silicone.m_poissonRatio = btScalar(0.4);
    btSoftBody* finger = btFemHelpers::createFromTetMesh(world.info(), fingerMesh());
    finger->translate(at(kApart, kPalm, 0));
    finger->rotate(btQuaternion(at(0, 1, 0), btScalar(angle)));
    for (int i = 0; i < finger->m_nodes.size(); ++i)
        if (finger->m_nodes[i].m_x.y() > kPalm - 1e-4) finger->appendAnchor(i, &palm, true);
    world.addSoft(finger, silicone, friction);
    std::vector<btFemChamber> cavities;
    btFemChamber::find(finger, cavities);
    return {finger, world.fem().addChamber(finger, cavities.at(0))};
}

void play(Demo& demo, double pressure, double young, double friction)
{
    btFemSolverInfo info;
    info.m_contactTolerance = btScalar(1e-2);
    DemoWorld world(info);
    world.addGround();
    world.addRigid(new btCylinderShape(at(0.012, kStand / 2, 0.012)), 0, at(0, kStand / 2, 0));
    btRigidBody& palm = world.addRigid(new btCylinderShape(at(0.08, 0.01, 0.08)), 0, at(0, kPalm + 0.01, 0));
    palm.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    palm.setActivationState(DISABLE_DEACTIVATION);
    std::vector<Finger> fingers;
    double weight = 0;
    for (const int k : {0, 1, 2})
    {
        fingers.push_back(addFinger(world, palm, SIMD_2_PI * k / 3, young, friction));
        weight += massOf(*fingers.back().first) * kGravity;
        demo.paint(*fingers.back().first, {0.36, 0.58, 0.72});
    }
    btFemMaterial foam = btFemMaterial::foam();
    foam.m_youngModulus = btScalar(1e4);
    foam.m_density = 150;
    btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), makeSphere(kBall, 6));
    ball->translate(at(0, kStand + kBall, 0));
    world.addSoft(ball, foam, friction);
    demo.paint(*ball, {0.80, 0.25, 0.20});
    weight += massOf(*ball) * kGravity;
    demo.look(at(0.24, 0.26, 0.56), at(0, 0.168, 0));

    btAlignedObjectArray<btFemActuatorReport> air;
    world.fem().getActuators(fingers[0].first, air);
    double empty = air[0].m_volume, carried = 0, samples = 0;
    do
    {
        const double filled = std::clamp((demo.time() - kFill) / (kFull - kFill), 0.0, 1.0);
        for (const auto& [finger, its] : fingers)
            world.fem().setChamberPressure(finger, its, btScalar(pressure * filled));
        const double lifted = kLift * std::clamp((demo.time() + kDemoStep - kUp) / (kHigh - kUp), 0.0, 1.0);
        palm.getWorldTransform().setOrigin(at(0, kPalm + 0.01 + lifted, 0));
        if (demo.time() < kHigh + 0.4) continue;
        for (const Finger& finger : fingers)
            for (int a = 0; a < world.fem().anchors(finger.first).size(); ++a)
                carried += double(world.fem().anchors(finger.first)[a].m_impulse.y()) / kDemoStep;
        ++samples;
    } while (demo.step(world.bullet()));
    world.fem().getActuators(fingers[0].first, air);
    demo.figure("weight", weight, "N");
    demo.check("rise / way of the palm", (centreOf(*ball).y() - kStand - kBall) / kLift, 0.8, 1.1, "", kHigh + 0.7);
    demo.check("force of the palm / weight", carried / samples / weight, 0.97, 1.03, "", kHigh + 0.7);
    demo.check("volume of the air / empty", air[0].m_volume / empty, 1.1, 2.5, "", kFull);
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("finger", "Three pneumatic fingers bend around a ball and lift it.", 3.5);
    double pressure = 1.8e5, young = 1.25e6, friction = 1.2;
    demo.option("--pressure", pressure, 0, 1e7, "gauge pressure of the air [Pa]");
    demo.option("--young", young, 1e3, 1e9, "Young's modulus of the fingers [Pa]");
    demo.option("--friction", friction, 0, 2, "friction between fingers and ball [-]");
    return demo.run(argc, argv, [&] { play(demo, pressure, young, friction); });
}
