// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A tensile test: two specimens, one of them notched, are pulled until they break. There are no predefined cracks.
#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemFracture.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr double kHeight = 0.6, kWidth = 0.2, kThick = 0.05, kWaist = 0.7;  // of a specimen [m], waist over width [-]
constexpr double kUp = 0.1, kApart = 0.17, kGrip = 0.05;  // height and distance of specimens, gripped length [m]
constexpr double kRest = 0.3, kPull = 1.8;                // start and duration of the pull [s]

/// A strip with wide ends, centred at x = `middle`; the notch is a third of the waist's width deep.
TetMesh specimen(double middle, bool isNotched)
{
    TetMesh box = makeBox({1, kHeight, kThick}, {9, 24, 2}, {-0.5, 0, -kThick / 2});
    if (isNotched) box = carved(box, {{{-1, kHeight / 2, -1}, {-1. / 6, kHeight * 13 / 24, 1}}});
    std::vector<Vec3> X = box.restPositions();
    for (Vec3& x : X)
    {
        const double wide = kWaist + (1 - kWaist) * std::pow(2 * x.y / kHeight - 1, 4);
        x = {middle + kWidth * wide * x.x, kUp + x.y, x.z};
    }
    return TetMesh(std::move(X), box.tets());
}

/// A kinematic clamp.
btRigidBody* addClamp(DemoWorld& world, double y)
{
    btRigidBody& clamp = world.addRigid(new btBoxShape(at(kApart + 0.15, kGrip, 0.06)), 0, at(0, y, 0));
    clamp.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    clamp.setActivationState(DISABLE_DEACTIVATION);
    return &clamp;
}

/// Vertical force on a body by its anchors to `clamp` [N].
double forceOf(DemoWorld& world, const btSoftBody* body, const btCollisionObject* clamp)
{
    double force = 0;
    for (int k = 0; k < world.fem().anchors(body).size(); ++k)
        if (world.fem().anchors(body)[k].m_object == clamp)
            force += double(world.fem().anchors(body)[k].m_impulse.y()) / kDemoStep;
    return force;
}

void play(Demo& demo, double young, double strength, double speed)
{
    DemoWorld world;
    world.addGround();
    const double up = kUp + kHeight;
    btRigidBody *foot = addClamp(world, kUp), *head = addClamp(world, up);
    btFemMaterial cork;
    cork.m_youngModulus = btScalar(young);
    cork.m_poissonRatio = 0;
    cork.m_density = 300;  // kg/m3
    btFemTensileStrength brittle;
    brittle.m_tension = btScalar(strength);
    btSoftBody* bodies[2];  // smooth, notched
    double pull[2] = {0, 0}, mass = 0, after = 0;
    for (const int k : {0, 1})
    {
        const TetMesh mesh = specimen(k == 1 ? kApart : -kApart, k == 1);
        bodies[k] = &world.addSoft(btFemHelpers::createFromTetMesh(world.info(), mesh), cork);
        btFemFracture::setStrength(world.fem(), bodies[k], brittle);
        for (int i = 0; i < bodies[k]->m_nodes.size(); ++i)
            for (btRigidBody* clamp : {foot, head})
                if (std::abs(bodies[k]->m_nodes[i].m_x.y() - clamp->getWorldTransform().getOrigin().y()) < kGrip)
                    bodies[k]->appendAnchor(i, clamp, true);
        demo.paint(*bodies[k], k == 1 ? Vec3{0.78, 0.50, 0.36} : Vec3{0.80, 0.64, 0.42});
        mass += massOf(*bodies[k]);
    }
    demo.look(at(0.45, 0.55, 1.55), at(0, 0.44, 0));
    while (demo.step(world.bullet()))
    {
        head->getWorldTransform().setOrigin(at(0, up + speed * std::clamp(demo.time() - kRest, 0.0, kPull), 0));
        for (const int k : {0, 1})  // force at mid-height: without half of the weight
            pull[k] = std::max(pull[k], (forceOf(world, bodies[k], head) - forceOf(world, bodies[k], foot)) / 2);
    }
    const auto& splits = btFemFracture::splits(world.fem());
    const double bears = strength * kWidth * kWaist * kThick;  // strength of the narrowest section [N]
    for (const int k : {0, 1})
    {
        int parts = 1;
        for (int event = 0; event < splits.size(); ++event)
            if (splits[event].m_body == bodies[k]) parts = splits[event].m_parts;
        demo.check(k == 1 ? "notched: parts" : "whole: parts", parts, 2, 2, "", kRest + kPull);
        after += massOf(*bodies[k]);
    }
    demo.check("mass after / before", after / mass, 0.99999, 1.00001, "", kRest + kPull);
    demo.check("whole: pull / strength x area", pull[0] / bears, 0.95, 1.03, "", kRest + kPull);
    demo.check("notched: pull / strength x area", pull[1] / (bears * 2 / 3), 0.25, 0.6, "", kRest + kPull);
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("tensile", "Two specimens, one of them notched, are pulled until they break.", 3);
    double young = 1e5, strength = 2e4, speed = 0.09;
    demo.option("--young", young, 1e3, 1e9, "Young's modulus [Pa]");
    demo.option("--strength", strength, 1, 1e9, "tensile strength [Pa]");
    demo.option("--speed", speed, 0, 10, "speed of the upper clamp [m/s]");
    return demo.run(argc, argv, [&] { play(demo, young, strength, speed); });
}
