// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The mouse's spring picks up a soft body with a ray, holds, swings and throws it.
#include <cmath>
#include <stdexcept>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemRay.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr double kLifted = 1, kHeld = 2.5, kThrown = 3;  // end times of the phases [s]
constexpr double kHeight = 1, kReach = 0.9;              // height of the lift, horizontal path of the throw [m]

/// Displacement of the mouse since the pick.
btVector3 mouseAt(double time)
{
    const double up = std::min(time / kLifted, 1.0), right = std::max((time - kHeld) / (kThrown - kHeld), 0.0);
    return at(kReach * right * right, kHeight * up * up * (3 - 2 * up) + 0.6 * right * right, 0);
}

/// Mouse press: attaches a spring to the point under the pointer.
btFemSpring pick(DemoWorld& world, const btSoftBody& body)
{
    btFemClosestRay ray(at(-1.55, 3, 0.1), at(-1.55, -1, 0.1));
    world.bullet().rayTest(ray.m_rayFromWorld, ray.m_rayToWorld, ray);
    if (!ray.hasHit() || ray.m_collisionObject != &body) throw std::runtime_error("the ray misses the body");
    btFemSpring spring = btFemSpring::at(ray.m_hit);
    spring.m_damping = 40;
    spring.m_maxForce = btScalar(20 * massOf(body) * kGravity);
    return spring;
}

btSoftBody& addRoll(DemoWorld& world, double young)
{
    btFemMaterial rubber;
    rubber.m_youngModulus = btScalar(young);
    btSoftBody* body = btFemHelpers::createFromTetMesh(world.info(), makeCylinder(0.15, 0.6, 6, 8));
    body->rotate(btQuaternion(at(0, 1, 0), btScalar(0.4)));
    body->translate(at(-1.5, 0.16, 0));
    return world.addSoft(body, rubber, 0.7);
}

void play(Demo& demo, double young, double stiffness, double drag)
{
    DemoWorld world;
    world.addGround();
    btSoftBody* body = &addRoll(world, young);
    body->m_cfg.kDP = btScalar(drag);
    const double mass = massOf(*body), weight = mass * kGravity;
    btFemSpring spring = pick(world, *body);
    spring.m_stiffness = btScalar(stiffness);
    int handle = world.fem().addSpring(body, spring);

    btVector3 pull(0, 0, 0), before(0, 0, 0), after(0, 0, 0);  // [N s], [m/s]
    btVector3 place(0, 0, 0), velocity(0, 0, 0), landing(0, 0, 0);
    int held = 0, flown = 0;  // steps
    bool flies = false;
    btCollisionObject& mouse = world.addMarker(new btSphereShape(btScalar(0.05)), spring.m_target);
    demo.paint(mouse, {0.15, 0.35, 0.75});
    do
    {
        const btScalar ahead = centreOf(*body).x();
        demo.look(at(ahead + 0.4, 1.5, 4.5), at(ahead, 0.75, 0));
        if (handle != 0 && demo.time() < kThrown)
        {
            const btVector3 target = spring.m_target + mouseAt(demo.time());
            mouse.setWorldTransform(btTransform(btQuaternion::getIdentity(), target));
            world.fem().setSpringTarget(body, handle, target);
        }
        else if (handle != 0)  // mouse release
        {
            world.fem().removeSpring(body, handle);
            handle = 0;
            flies = true;
            place = landing = centreOf(*body);
            velocity = velocityOf(*body);
        }
        else if (flies && world.fem().contacts(body).size() == 0)
        {
            landing = centreOf(*body);
            ++flown;
        }
        else
            flies = false;
        if (demo.time() < kLifted) before = velocityOf(*body);
        if (demo.time() < kLifted || demo.time() > kHeld) continue;
        after = velocityOf(*body);
        pull += world.fem().anchors(body)[0].m_impulse;
        ++held;
    } while (demo.step(world.bullet()));

    const double t = flown * kDemoStep, lifted = double((after - before).y()) * mass;  // momentum of the swing
    const btVector3 parabola = place + velocity * btScalar(t) + at(0, -kGravity * t * t / 2, 0);
    demo.figure("weight", weight, "N");
    demo.check("pull while held / weight and swing", double(pull.y()) / (weight * held * kDemoStep + lifted), 0.99,
               1.01, "", kHeld);
    demo.check("speed when it is let go", velocity.length(), 2, 8, "m/s", kThrown + 1);
    demo.check("way of its flight", (landing - place).x(), 1, 10, "m", kThrown + 1);
    demo.check("distance from its parabola", (landing - parabola).length(), 0, 0.02, "m", kThrown + 1);
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("throw", "The mouse's spring picks a soft body up, holds it, swings it and throws it.", 5);
    double young = 2e5, stiffness = 4000, drag = 0;
    demo.option("--young", young, 1e3, 1e9, "Young's modulus [Pa]");
    demo.option("--stiffness", stiffness, 0, 1e9, "stiffness of the spring [N/m]");
    demo.option("--drag", drag, 0, 1, "drag of the body, Bullet's kDP [-]");
    return demo.run(argc, argv, [&] { play(demo, young, stiffness, drag); });
}
