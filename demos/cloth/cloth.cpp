// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bullet's cloth falls over a soft body, hangs on it and loads it with its weight.
#include <algorithm>
#include <cmath>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr double kRadius = 0.4, kHeight = 0.6, kEdge = 1.2;  // of the soft bodies, of the cloth's side [m]
constexpr double kMargin = 0.02;                             // between them [m]
constexpr int kNodes = 21;                                   // along a side of the cloth

btSoftBody& addCloth(DemoWorld& world, double mass, bool touches)
{
    const double a = kEdge / 2, y = kHeight + 0.25;
    btSoftBody* cloth = btSoftBodyHelpers::CreatePatch(world.info(), at(-a, y, -a), at(a, y, -a), at(-a, y, a),
                                                       at(a, y, a), kNodes, kNodes, 0, true);
    cloth->setTotalMass(btScalar(mass));
    cloth->getCollisionShape()->setMargin(btScalar(kMargin));
    cloth->m_cfg.piterations = 8;
    cloth->m_cfg.kDP = btScalar(0.02);  // air drag
    cloth->m_cfg.kDF = btScalar(0.6);
    if (touches) cloth->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    return world.addCloth(cloth);
}

void play(Demo& demo, double young, double mass, bool touches)
{
    DemoWorld world;
    btRigidBody& ground = world.addGround();
    btFemMaterial material;
    material.m_youngModulus = btScalar(young);
    material.m_density = 60;
    btSoftBody* stool = btFemHelpers::createFromTetMesh(world.info(), makeCylinder(kRadius, kHeight, 6, 6));
    stool->rotate(btQuaternion(at(1, 0, 0), SIMD_HALF_PI));
    stool->translate(at(0, kHeight / 2, 0));
    world.addSoft(stool, material, 0.6);
    btSoftBody& cloth = addCloth(world, mass, touches);
    demo.paint(cloth, {0.72, 0.24, 0.30});
    demo.look(at(1.1, 1.2, 2.2), at(0, 0.42, 0));

    const double weight = mass * kGravity, own = massOf(*stool) * kGravity;
    double onStool = 0, onGround = 0, lowest = 1;
    int samples = 0;
    do
    {
        if (demo.time() < 3) continue;
        onStool -= double(world.fem().contactForce(stool, &cloth).y());
        onGround += double(world.fem().contactForce(stool, &ground).y());
        lowest = std::min(lowest, double(lowestOf(cloth).y()));
        ++samples;
    } while (demo.step(world.bullet()));
    demo.figure("weight of the cloth", weight, "N");
    demo.figure("nodes of the cloth", cloth.m_nodes.size(), "");
    demo.check("force of the cloth on the body / weight", onStool / samples / weight, 0.93, 1.07, "", 5);
    demo.check("force of the ground / weight of both", onGround / samples / (weight + own), 0.98, 1.02, "", 5);
    demo.check("lowest hem", lowest, 0.08, 0.4, "m", 5);
    demo.check("height of what it lies on", highestOf(*stool).y(), 0.8 * kHeight, kHeight, "m", 5);
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("cloth", "Bullet's cloth falls over a soft body, hangs on it and loads it with its weight.", 5);
    double young = 3e4, mass = 1;
    bool fallsThrough = false;
    demo.option("--young", young, 1e2, 1e9, "Young's modulus of the body [Pa]");
    demo.option("--mass", mass, 1e-3, 1e3, "mass of the cloth [kg]");
    demo.flag("--no-contact", fallsThrough, "the cloth lacks the flag VF_SS, and falls through");
    return demo.run(argc, argv, [&] { play(demo, young, mass, !fallsThrough); });
}
