// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Steel balls are lowered onto a panel of clay and lifted again, which leaves dents. The state is saved. A heavier ball
// destroys the dents; restoring the state brings them back.
#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr double kEdge = 0.6, kThick = 0.15, kCell = 0.0375;             // of the panel and its elements [m]
constexpr double kSteel = 7850;                                          // [kg/m3]
constexpr double kLetDown = 0.7, kLift = 1, kGone = 1.7, kSpoilt = 2.6;  // end times of the phases [s]
constexpr int kBalls = 3;
constexpr double kRadii[kBalls] = {0.08, 0.1, 0.12};                                 // [m]
constexpr double kPlaces[kBalls][2] = {{-0.16, 0.18}, {0.16, 0.1}, {-0.08, -0.13}};  // x and z [m]

const auto massOfBall = [](double radius) { return kSteel * 4 / 3 * SIMD_PI * std::pow(radius, 3); };  // [kg]

btRigidBody& addBall(DemoWorld& world, double radius, double height, double x, double z)
{
    btRigidBody& ball =
        world.addRigid(new btSphereShape(btScalar(radius)), massOfBall(radius), at(x, kThick + height + radius, z));
    ball.setActivationState(DISABLE_DEACTIVATION);
    return ball;
}

/// Depth of a ball's dent: the mean pressure on the projected contact area is three times the yield stress [Tabor, The
/// Hardness of Metals, 1951].
double depthByFormula(double radius, double yield)
{
    const double area = massOfBall(radius) * kGravity / (3 * yield);
    return radius - std::sqrt(std::max(radius * radius - area / SIMD_PI, 0.0));
}

/// Depth of the deepest node of the upper side near the centre of a dent [m].
double depthAt(const btSoftBody& clay, const std::vector<int>& top, double x, double z)
{
    double depth = 0;
    for (const int i : top)
    {
        const btVector3 r = clay.m_nodes[i].m_x - at(x, kThick, z);
        if (std::hypot(r.x(), r.z()) < 1.5 * kCell) depth = std::max(depth, -double(r.y()));
    }
    return depth;
}

void play(Demo& demo, double young, double yield, bool restore)
{
    DemoWorld world;
    world.addGround();
    btFemMaterial material = btFemMaterial::clay();  // undeformed
    material.m_youngModulus = btScalar(young);
    material.m_yieldStress = btScalar(yield);
    btSoftBody* clay = btFemHelpers::createBox(world.info(), at(0, kThick / 2, 0), at(kEdge / 2, kThick / 2, kEdge / 2),
                                               btScalar(kCell));
    std::vector<int> top;
    for (int i = 0; i < clay->m_nodes.size(); ++i)
        if (clay->m_nodes[i].m_x.y() > kThick - 1e-3)
            top.push_back(i);
        else if (clay->m_nodes[i].m_x.y() < 1e-3)
            clay->setMass(i, 0);  // fixed to the ground
    world.addSoft(clay, material, 0.8);
    demo.paint(*clay, {0.74, 0.58, 0.46});
    demo.look(at(0.6, 0.9, 1.45), at(0, 0.19, 0));
    btRigidBody *balls[kBalls], *heavy = nullptr;
    for (int k = 0; k < kBalls; ++k) balls[k] = &addBall(world, kRadii[k], 0.002, kPlaces[k][0], kPlaces[k][1]);
    std::vector<unsigned char> saved;
    double depths[kBalls] = {}, spoilt = 0, changed = 0;
    const auto depth = [&](int k) { return depthAt(*clay, top, kPlaces[k][0], kPlaces[k][1]); };
    const auto isAt = [&](double time) { return std::abs(demo.time() - time) < kDemoStep / 2; };
    do
    {
        const double hangs = 1 - std::min(std::floor(1 + 5 * demo.time() / kLetDown), 5.0) / 5;  // the crane's share
        for (btRigidBody* ball : balls)
            ball->setGravity(at(0, demo.time() < kLift ? -kGravity * (1 - hangs) : 0.5 * kGravity, 0));
        if (isAt(kGone))
        {
            for (int k = 0; k < kBalls; ++k) depths[k] = depth(k);
            world.fem().saveState(saved);
            for (btRigidBody* ball : balls) world.bullet().removeRigidBody(ball);
            heavy = &addBall(world, 0.2, 0.1, 0, 0);
        }
        if (isAt(kSpoilt))
        {
            for (int k = 0; k < kBalls; ++k) spoilt = std::max(spoilt, std::abs(depth(k) / depths[k] - 1));
            world.bullet().removeRigidBody(heavy);
            if (restore) world.fem().restoreState(saved.data(), saved.size());
        }
    } while (demo.step(world.bullet()));
    for (int k = 0; k < kBalls; ++k)
    {
        changed = std::max(changed, std::abs(depth(k) / depths[k] - 1));
        demo.check("dent " + std::to_string(k + 1) + ": depth / formula", depths[k] / depthByFormula(kRadii[k], yield),
                   0.75, 1.5, "", kGone);
    }
    demo.check("dents changed by the heavy ball", spoilt, 0.1, 10, "", kSpoilt);
    demo.check("dents changed after restoring", changed, 0, 0.01, "", kSpoilt + 0.5);
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("dents", "Balls dent a slab of clay; the dents stay, are spoilt, and are restored.", 3.6);
    double young = 2.5e5, yield = 5e3;
    bool staysSpoilt = false;
    demo.option("--young", young, 1e3, 1e13, "Young's modulus of the clay [Pa]");
    demo.option("--yield", yield, 1, 1e13, "yield stress of the clay [Pa]");
    demo.flag("--no-restore", staysSpoilt, "the saved state is not restored");
    return demo.run(argc, argv, [&] { play(demo, young, yield, !staysSpoilt); });
}
