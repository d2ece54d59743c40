// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A soft dog walks by muscle fibres in its legs. Each leg has a front and a rear bundle: both together shorten it, one
// alone swings its foot. Diagonally opposite legs move in phase.
#include <algorithm>
#include <cmath>
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

constexpr double kCell = 0.02, kLeg = 0.16, kThick = 0.08;  // cell size of the mesh; length and width of a leg [m]
constexpr double kStart = 0.5;                              // start of walking [s]
const Vec3 kLow{-0.24, 0, -0.12}, kHigh{0.32, 0.36, 0.12};  // corners of the block from which the dog is carved [m]
const std::vector<Block> kHoles = {
    {{-0.12, 0, -1}, {0.12, kLeg, 1}},     {{-1, 0, -0.04}, {1, kLeg, 0.04}},   {{0.2, 0, -1}, {1, 0.22, 1}},
    {{-1, 0, -1}, {-0.2, 0.22, 1}},        {{-0.16, 0.24, -1}, {0.14, 1, 1}},   {{0.14, 0.24, -1}, {1, 1, -0.06}},
    {{0.14, 0.24, 0.06}, {1, 1, 1}},       {{-1, 0.24, -1}, {-0.16, 1, -0.02}}, {{-1, 0.24, 0.02}, {-0.16, 1, 1}},
    {{-1, 0.34, -1}, {-0.16, 1, 1}},       {{0.2, 0.22, -1}, {1, 0.24, -0.06}}, {{0.2, 0.22, 0.06}, {1, 0.24, 1}},
    {{-1, 0.22, -1}, {-0.2, 0.24, -0.02}}, {{-1, 0.22, 0.02}, {-0.2, 0.24, 1}}};

using Bundle = std::pair<int, double>;  // handle of the fibres, phase in the period

/// Triangle wave from 0 to 1 and back within a period.
double wave(double phase)
{
    return 1 - std::abs(2 * (phase - std::floor(phase)) - 1);
}

std::vector<Bundle> addBundles(DemoWorld& world, btSoftBody& dog)
{
    std::vector<Bundle> bundles;
    for (const double x : {-0.16, 0.16})
        for (const double z : {-0.08, 0.08})
            for (const bool front : {false, true})
            {
                const double low = front ? x : x - kThick / 2;
                btFemFibres fibres;
                fibres.m_tets = elementsIn(dog, {{low, 0, z - kThick / 2}, {low + kThick / 2, kLeg, z + kThick / 2}});
                fibres.m_directions = {at(0, 1, 0)};
                bundles.push_back({world.fem().addFibres(&dog, fibres), (x * z > 0 ? 0 : 0.5) - (front ? 0.25 : 0)});
            }
    return bundles;
}

void play(Demo& demo, double young, double activation, double period, double friction)
{
    DemoWorld world;
    btRigidBody& ground = world.addGround();
    const Vec3 size = kHigh - kLow;
    const auto cells = [&](int axis) { return static_cast<int>(std::lround(size[axis] / kCell)); };
    btFemMaterial material;
    material.m_youngModulus = btScalar(young);
    material.m_density = 500;
    btSoftBody* dog = btFemHelpers::createFromTetMesh(
        world.info(), carved(makeBox(size, {cells(0), cells(1), cells(2)}, kLow), kHoles));
    world.addSoft(dog, material, friction);
    const std::vector<Bundle> bundles = addBundles(world, *dog);
    std::vector<std::pair<int, btCollisionObject*>> face;  // eyes and nose, attached to nodes
    for (const btVector3& place : {at(0.32, 0.32, -0.04), at(0.32, 0.32, 0.04), at(0.32, 0.26, 0)})
        for (int i = 0; i < dog->m_nodes.size(); ++i)
            if ((dog->m_nodes[i].m_x - place).length() < kCell / 10)
            {
                face.emplace_back(i, &world.addMarker(new btSphereShape(btScalar(0.014)), place));
                demo.paint(*face.back().second, {0.1, 0.1, 0.12});
            }

    double carried = 0, lowest = 1, samples = 0;
    btVector3 from(0, 0, 0);
    do
    {
        for (const auto& [fibres, phase] : bundles)
        {
            const double grows = std::clamp((demo.time() - kStart) / period, 0.0, 1.0);
            const double now = activation * grows * wave(demo.time() / period + phase);
            world.fem().setActivation(dog, fibres, btScalar(now));
        }
        for (const auto& [node, marker] : face) marker->getWorldTransform().setOrigin(dog->m_nodes[node].m_x);
        const btVector3 centre = centreOf(*dog);
        demo.look(at(centre.x() + 0.75, 0.5, 1.05), at(centre.x() + 0.04, 0.17, 0));
        if (demo.time() < kStart + 2 * period) from = centre;
        if (demo.time() < kStart + 2 * period) continue;
        carried += double(world.fem().contactForce(dog, &ground).y());
        lowest = std::min(lowest, double(centre.y()));
        ++samples;
    } while (demo.step(world.bullet()));
    const btVector3 way = centreOf(*dog) - from;
    const double speed = double(way.x()) / std::max(samples * kDemoStep, kDemoStep);
    demo.figure("force of the ground / weight", carried / samples / (massOf(*dog) * kGravity), "");
    demo.figure("way", way.x(), "m");
    demo.figure("way of a period", speed * period, "m");
    demo.check("speed", speed, 0.05, 0.5, "m/s", 5);
    demo.check("aside / ahead", std::abs(double(way.z() / way.x())), 0, 0.2, "", 5);
    demo.check("lowest centre", lowest, 0.12, 0.3, "m", 5);
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("walker", "A soft dog walks on muscle fibres in its legs.", 6);
    double young = 3e5, activation = 1.8e5, period = 0.5, friction = 0.8;
    demo.option("--young", young, 1e3, 1e9, "Young's modulus [Pa]");
    demo.option("--activation", activation, 0, 1e7, "largest stress of the fibres [Pa]");
    demo.option("--period", period, 0.05, 10, "period of the gait [s]");
    demo.option("--friction", friction, 0, 2, "friction between feet and ground [-]");
    return demo.run(argc, argv, [&] { play(demo, young, activation, period, friction); });
}
