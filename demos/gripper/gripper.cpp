// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A gripper lifts a soft fruit: a multibody of a palm and two motorised fingers, with soft pads on the fingers.
#include <algorithm>
#include <cmath>

#include "BulletDynamics/Featherstone/btMultiBodyJointMotor.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr double kRadius = 0.06, kPedestal = 0.2;                                // [m]
constexpr double kLiftFrom = 1.2, kLiftTo = 2.7;                                 // [s]
constexpr double kLiftSpeed = 0.15, kCloseSpeed = 0.15;                          // [m/s]
const btVector3 kFinger = at(0.012, 0.12, 0.04), kPad = at(0.015, 0.045, 0.04);  // half edges [m]

struct Hand
{
    btMultiBody* m_body;
    btMultiBodyJointMotor* m_lift;
    btSoftBody* m_pads[2];
};

btVector3 inertiaOf(double mass, const btVector3& half)
{
    btVector3 inertia;
    btBoxShape(half).calculateLocalInertia(btScalar(mass), inertia);
    return inertia;
}

/// A palm on a vertical slider, and two fingers on sliders along x.
Hand addHand(DemoLinkWorld& world, double grip, double friction)
{
    const btVector3 none(0, 0, 0), palm = at(0.16, 0.02, 0.05);
    const btQuaternion straight = btQuaternion::getIdentity();
    const double height = kPedestal + kRadius;
    Hand hand;
    hand.m_body = new btMultiBody(3, 0, none, true, false);
    hand.m_body->setBasePos(at(0, height + 0.16, 0));
    hand.m_body->setupPrismatic(0, 1, inertiaOf(1, palm), -1, straight, at(0, 1, 0), none, none, false);
    for (const int side : {0, 1})
        hand.m_body->setupPrismatic(1 + side, 0.3f, inertiaOf(0.3, kFinger), 0, straight, at(side ? -1 : 1, 0, 0),
                                    at(side ? 0.13 : -0.13, -0.13, 0), none, true);
    world.addMultiBody(hand.m_body);
    world.addLink(*hand.m_body, 0, new btBoxShape(palm));
    hand.m_lift = &world.addMotor<btMultiBodyJointMotor>(hand.m_body, 0, btScalar(0), btScalar(500 * kDemoStep));
    for (const int side : {0, 1})
    {
        btMultiBodyLinkCollider& finger = world.addLink(*hand.m_body, 1 + side, new btBoxShape(kFinger));
        world.addMotor<btMultiBodyJointMotor>(hand.m_body, 1 + side, btScalar(kCloseSpeed), btScalar(grip * kDemoStep));
        btFemMaterial rubber = btFemMaterial::rubber();
        rubber.m_youngModulus = btScalar(2e5);
        const double out = side ? 1 : -1, face = 0.13 - kFinger.x();
        btSoftBody* pad =
            btFemHelpers::createBox(world.info(), at(out * (face - kPad.x()), height, 0), kPad, btScalar(0.015));
        for (int i = 0; i < pad->m_nodes.size(); ++i)  // anchors it to the finger
            if (std::abs(pad->m_nodes[i].m_x.x()) > face - 1e-4) pad->appendDeformableAnchor(i, &finger);
        pad->m_collisionDisabledObjects.push_back(&finger);
        hand.m_pads[side] = &world.addSoft(pad, rubber, friction);
    }
    return hand;
}

void play(Demo& demo, double grip, double friction)
{
    DemoLinkWorld world;
    world.addGround();
    world.addRigid(new btBoxShape(at(0.03, kPedestal / 2, 0.03)), 0, at(0, kPedestal / 2, 0));
    const Hand hand = addHand(world, grip, friction);
    btFemMaterial flesh = btFemMaterial::flesh();
    btSoftBody* fruit = btFemHelpers::createFromTetMesh(world.info(), makeSphere(kRadius, 6));
    fruit->translate(at(0, kPedestal + kRadius, 0));
    world.addSoft(fruit, flesh, friction);
    demo.paint(*fruit, {0.80, 0.25, 0.20});
    demo.look(at(0.5, 0.65, 1.5), at(0, 0.34, 0), 0.5);

    const double weight = massOf(*fruit) * kGravity;
    btVector3 force[2];
    double hung = 0, pressed = 0, narrowest = 1;
    int samples = 0;
    do
    {
        const bool lifts = demo.time() > kLiftFrom && demo.time() < kLiftTo;
        hand.m_lift->setVelocityTarget(btScalar(lifts ? kLiftSpeed : 0));
        for (const int side : {0, 1}) force[side] = world.fem().contactForce(fruit, hand.m_pads[side]);
        if (demo.time() < kLiftTo + 0.8) continue;
        hung += double(force[0].y() + force[1].y()) / weight;
        pressed += double(force[0].x() - force[1].x()) / (2 * grip);
        narrowest = std::min(narrowest, double(sizeOf(*fruit).x()) / (2 * kRadius));
        ++samples;
    } while (demo.step(world.bullet()));
    const double rise = centreOf(*fruit).y() - kPedestal - kRadius, end = kLiftTo + 1.3;
    demo.figure("weight", weight, "N");
    demo.check("rise / way of the palm", rise / (kLiftSpeed * (kLiftTo - kLiftFrom)), 0.95, 1.05, "", end);
    demo.check("force of the pads upwards / weight", hung / samples, 0.98, 1.02, "", end);
    demo.check("force of a pad / motor's", pressed / samples, 0.97, 1.03, "", end);
    demo.check("width of the fruit / at rest", narrowest, 0.75, 1, "", end);
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("gripper", "A gripper of multibody fingers with soft pads lifts a soft fruit.", 4);
    double grip = 15, friction = 0.8;
    demo.option("--grip", grip, 0, 1e4, "force of the fingers' motors [N]");
    demo.option("--friction", friction, 0, 2, "friction between pads and fruit [-]");
    return demo.run(argc, argv, [&] { play(demo, grip, friction); });
}
