// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Balls of three stiffnesses and a rigid sphere of Bullet fall onto a slope, bounce and roll down side by side.
#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr double kRadius = 0.25, kDensity = 1000;  // [m], [kg/m3]
constexpr double kFall = 0.5, kSlope = 8;          // [m], [degrees]
constexpr double kModuli[] = {3e4, 3e5, 3e6};      // [Pa]

btFemMaterial materialOf(double young, double damping)
{
    btFemMaterial material;
    material.m_youngModulus = btScalar(young);
    material.m_density = btScalar(kDensity);
    material.m_stiffnessDamping = btScalar(damping);
    return material;
}

const char* const kNames[] = {"soft", "medium", "hard"};
constexpr double kLeastRebound[] = {0.5, 0.75, 0.85};  // energy of vibrations after the impact is lost
// Share of a rigid sphere's speed: 85 % of that in steps of 1/960 s, .65, .84 and .90, as implicit Euler in contact
// damps rolling.
constexpr double kLeastSpeed[] = {0.55, 0.71, 0.76};

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("balls", "Balls of three stiffnesses and Bullet's rigid sphere bounce and roll down a slope.", 4);
    double friction = 0.9, damping = 0.002, restitution = 0.6;
    demo.option("--friction", friction, 0, 2, "friction between balls and slope [-]");
    demo.option("--damping", damping, 0, 1, "stiffness damping of the balls [s]");
    demo.option("--restitution", restitution, 0, 1, "restitution of all four bodies [-]");
    const auto scene = [&]
    {
        DemoWorld world;
        const double angle = kSlope * SIMD_RADS_PER_DEG;
        const btVector3 down = at(std::cos(angle), -std::sin(angle), 0),
                        normal = at(std::sin(angle), std::cos(angle), 0);
        const btTransform tilted(btQuaternion(at(0, 0, 1), btScalar(-angle)), down * 6 - normal * btScalar(0.1));
        world.addRigid(new btBoxShape(at(8, 0.1, 1.8)), 0, tilted).setRestitution(1);

        const auto start = [&](int lane) { return normal * btScalar(kRadius + kFall) + at(0, 0, 0.8 * (1.5 - lane)); };
        const double mass = kDensity * 4 / 3 * SIMD_PI * std::pow(kRadius, 3);
        btRigidBody& rigid = world.addRigid(new btSphereShape(btScalar(kRadius)), mass, start(3), friction);
        rigid.setRestitution(btScalar(restitution));
        std::vector<btSoftBody*> balls;
        for (const double young : kModuli)
        {
            btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), makeSphere(kRadius, 8));
            ball->translate(start(static_cast<int>(balls.size())));
            balls.push_back(&world.addSoft(ball, materialOf(young, damping), friction));
            balls.back()->setRestitution(btScalar(restitution));
        }

        double rebound[3] = {0, 0, 0};  // maximum height after the first contact, above the height in contact [m]
        bool landed[3] = {false, false, false};
        do
        {
            for (int k = 0; k < 3; ++k)
            {
                landed[k] = landed[k] || world.fem().contacts(balls[k]).size() > 0;
                if (landed[k] && velocityOf(*balls[k]).dot(normal) > 0)
                    rebound[k] = std::max(rebound[k], double(centreOf(*balls[k]).dot(normal)) - kRadius);
            }
            const btScalar way = btScalar(0.75) * down.dot(rigid.getCenterOfMassPosition());
            demo.look(down * way + at(2, 1.7, 5.6), down * (way + btScalar(0.4)));
        } while (demo.step(world.bullet()));

        // Speed of a rigid sphere that rolls without slip, from the balance of angular momentum about the contact
        // point.
        const double rolling = 5.0 / 7 * kGravity * std::sin(angle) * demo.time();
        demo.check("rigid sphere: speed / rolling", rigid.getLinearVelocity().dot(down) / rolling, 0.98, 1.02, "", 2);
        for (int k = 0; k < 3; ++k)
        {
            const std::string name = kNames[k] + std::string(" ball: ");
            demo.figure(name + "speed", velocityOf(*balls[k]).dot(down), "m/s");
            demo.check(name + "rebound / e^2 fall", rebound[k] / (kFall * restitution * restitution), kLeastRebound[k],
                       1.25, "", 1);
            demo.check(name + "speed / rolling", velocityOf(*balls[k]).dot(down) / rolling, kLeastSpeed[k], 1.02, "",
                       2);
        }
    };
    return demo.run(argc, argv, scene);
}
