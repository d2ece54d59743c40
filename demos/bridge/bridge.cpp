// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A bridge of rigid planks and soft cushions that are anchored to each other and to two piers. Crates fall on it.
#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr int kPlanks = 5;
constexpr double kPlank = 0.4, kCushion = 0.2, kWidth = 0.8, kThick = 0.12;  // [m]
constexpr double kDeck = 1.5, kPlankMass = 15, kCrateMass = 12;              // [m], [kg]
constexpr double kSpan = kPlanks * kPlank + (kPlanks + 1) * kCushion;
constexpr int kCrates = 3;

/// Adds a cushion between two rigid bodies; the nodes at its ends are anchored to them.
btSoftBody& addCushion(DemoSwapWorld& world, double x, btRigidBody& left, btRigidBody& right, double young)
{
    btFemMaterial material = btFemMaterial::rubber();
    material.m_youngModulus = btScalar(young);
    const btVector3 half = at(kCushion / 2, kThick / 2, kWidth / 2);
    btSoftBody* cushion = btFemHelpers::createBox(world.info(), at(x, kDeck, 0), half, btScalar(0.067));
    for (int i = 0; i < cushion->m_nodes.size(); ++i)
    {
        const double along = cushion->m_nodes[i].m_x.x() - x;
        if (along < -0.499 * kCushion) cushion->appendAnchor(i, &left, true);
        if (along > 0.499 * kCushion) cushion->appendAnchor(i, &right, true);
    }
    return world.addSoft(cushion, material, 0.6);
}

void play(Demo& demo, double young, double crateMass, double aside)
{
    DemoSwapWorld world;
    world.addGround();
    std::vector<btRigidBody*> supports;  // pier, planks, pier
    for (const double side : {-1.0, 1.0})
    {
        const btVector3 half = at(0.4, (kDeck + kThick / 2) / 2, kWidth / 2);
        supports.push_back(&world.addRigid(new btBoxShape(half), 0, at(side * (kSpan / 2 + 0.4), half.y(), 0)));
    }
    const auto left = [](int k) { return -kSpan / 2 + k * (kPlank + kCushion); };  // end of cushion k
    for (int k = 0; k < kPlanks; ++k)
    {
        btRigidBody& plank = world.addRigid(new btBoxShape(at(kPlank / 2, kThick / 2, kWidth / 2)), kPlankMass,
                                            at(left(k) + kCushion + kPlank / 2, kDeck, 0));
        demo.paint(plank, {0.62, 0.48, 0.34});
        supports.insert(supports.end() - 1, &plank);
    }
    std::vector<btSoftBody*> cushions;
    double weight = (kPlanks * kPlankMass + kCrates * crateMass) * kGravity;
    for (int k = 0; k <= kPlanks; ++k)
    {
        cushions.push_back(&addCushion(world, left(k) + kCushion / 2, *supports[k], *supports[k + 1], young));
        weight += massOf(*cushions.back()) * kGravity;
    }
    std::vector<btRigidBody*> crates;
    for (int k = 0; k < kCrates; ++k)
        crates.push_back(&world.addRigid(new btBoxShape(at(0.15, 0.15, 0.15)), crateMass,
                                         at(0.5 * (k - 1), kDeck + 0.5 + 0.3 * k, 0.1 * k + aside)));
    demo.look(at(1.3, 2.5, 6.5), at(0.13, 1.1, 0));

    double carried = 0, apart = 0;
    int samples = 0;
    do
    {
        for (const btSoftBody* cushion : cushions)
            for (int a = 0; a < world.fem().anchors(cushion).size(); ++a)
            {
                const btFemAnchorReport& anchor = world.fem().anchors(cushion)[a];
                apart = std::max(apart, double(anchor.m_error));
                if (demo.time() > 5 && anchor.m_object->isStaticObject())
                    carried += double(anchor.m_impulse.y()) / kDemoStep;
            }
        samples += demo.time() > 5;
    } while (apart < kCushion && demo.step(world.bullet()));
    const bool isBroken = apart >= kCushion;  // the parts of a broken bridge keep falling
    const double from = isBroken ? 0 : 7;
    const double sag = kDeck - supports[kPlanks / 2 + 1]->getCenterOfMassPosition().y();
    double lowestCrate = 10;
    for (const btRigidBody* crate : crates)
        lowestCrate = std::min(lowestCrate, double(crate->getCenterOfMassPosition().y()));
    demo.figure("weight", weight, "N");
    if (isBroken) demo.figure("gave way after", demo.time(), "s");
    demo.check("force of the piers / weight", carried / std::max(samples, 1) / weight, 0.98, 1.02, "", from);
    demo.check("sag / span", sag / kSpan, 0.02, 0.25, "", from);
    demo.check("lowest crate", lowestCrate, 0.5, kDeck + 0.5, "m", from);
    demo.check("anchors apart at most", apart, 0, 0.02, "m");
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("bridge", "A bridge of planks and soft cushions, anchored to each other, carries crates.", 7);
    double young = 4e5, crateMass = kCrateMass, aside = 0;
    demo.option("--young", young, 1e3, 1e9, "Young's modulus of the cushions [Pa]");
    demo.option("--crate", crateMass, 0.1, 1e4, "mass of a crate [kg]");
    demo.option("--aside", aside, -10, 10, "lateral offset of the crates [m]");
    return demo.run(argc, argv, [&] { play(demo, young, crateMass, aside); });
}
