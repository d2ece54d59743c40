// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A car with soft tyres drives over bumps. Its wheels are rigid hubs on Bullet's hinges; the tyres are anchored to the
// hubs.
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

constexpr double kTyre = 0.4, kHub = 0.16, kWidth = 0.25;  // radii and width of a wheel [m]
constexpr double kChassisMass = 400, kHubMass = 30;        // [kg]
constexpr double kWantedSpeed = 4;                         // [m/s]

/// A cylinder around z whose inner nodes are anchored to the hub.
btSoftBody& addTyre(DemoWorld& world, btRigidBody& hub, double young)
{
    btFemMaterial rubber;
    rubber.m_youngModulus = btScalar(young);  // [Pa], of the rubber and its air as one material
    rubber.m_density = 300;
    const btVector3 centre = hub.getWorldTransform().getOrigin();
    btSoftBody* tyre = btFemHelpers::createFromTetMesh(world.info(), makeCylinder(kTyre, kWidth, 8, 2));
    tyre->translate(centre);
    for (int i = 0; i < tyre->m_nodes.size(); ++i)
    {
        const btVector3 r = tyre->m_nodes[i].m_x - centre;
        if (std::hypot(r.x(), r.y()) < kHub) tyre->appendAnchor(i, &hub, true);
    }
    return world.addSoft(tyre, rubber, 1);
}

void addBumps(DemoWorld& world, double height)
{
    for (int k = 0; k < 6; ++k)  // a long bump under both wheels, then shorter ones, left and right alternately
    {
        const double radius = 0.5, half = k == 0 ? 1.5 : 0.6, side = k == 0 ? 0 : k % 2 ? 0.75 : -0.75;
        const btTransform pose(btQuaternion(at(1, 0, 0), SIMD_HALF_PI), at(6 + 1.5 * k, height - radius, side));
        world.addRigid(new btCylinderShape(at(radius, half, radius)), 0, pose);
    }
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("car", "A car with soft tyres drives over bumps.", 6);
    double young = 4e5, torque = 120, bump = 0.08;
    demo.option("--young", young, 1e3, 1e9, "Young's modulus of the tyres [Pa]");
    demo.option("--torque", torque, 0, 1e4, "maximum torque of the motor on each wheel [N m]");
    demo.option("--bump", bump, 0, 0.5, "height of the bumps [m]");
    const auto scene = [&]
    {
        DemoWorld world;
        world.addGround();
        addBumps(world, bump);
        btRigidBody& chassis =
            world.addRigid(new btBoxShape(at(1.1, 0.16, 0.45)), kChassisMass, at(0, kTyre + 0.12, 0));
        chassis.setActivationState(DISABLE_DEACTIVATION);
        std::vector<btRigidBody*> hubs;
        std::vector<btSoftBody*> tyres;
        double weight = kChassisMass * kGravity;
        for (const double x : {-0.8, 0.8})
            for (const double z : {-0.75, 0.75})
            {
                const btVector3 centre = at(x, kTyre, z), axis(0, 0, 1);
                hubs.push_back(&world.addRigid(new btCylinderShapeZ(at(kHub, kHub, 0.6 * kWidth)), kHubMass, centre));
                world.addJoint<btHingeConstraint>(chassis, *hubs.back(), centre - chassis.getCenterOfMassPosition(),
                                                  at(0, 0, 0), axis, axis);
                tyres.push_back(&addTyre(world, *hubs.back(), young));
                weight += (kHubMass + massOf(*tyres.back())) * kGravity;
            }

        double carried = 0, lowest = kTyre, tilt = 0;
        int samples = 0;
        const auto speed = [&] { return double(chassis.getLinearVelocity().x()); };
        demo.paint(chassis, {0.72, 0.24, 0.22});
        for (const btSoftBody* tyre : tyres) demo.paint(*tyre, {0.25, 0.26, 0.28});
        do
        {
            const btVector3 place = chassis.getCenterOfMassPosition();
            demo.look(place + at(1.1, 1.2, 5.2), place + at(0.2, -0.2, 0));
            const btVector3 wheel = at(0, 0, -torque * std::clamp(2 * (kWantedSpeed - speed()), -1.0, 1.0));
            for (btRigidBody* hub : hubs)
            {
                hub->applyTorque(wheel);
                chassis.applyTorque(-wheel);
                lowest = std::min(lowest, double(hub->getCenterOfMassPosition().y()));
            }
            tilt = std::max(tilt, std::acos(double(chassis.getWorldTransform().getBasis()[1][1])) * SIMD_DEGS_PER_RAD);
            for (const btSoftBody* tyre : tyres)
                for (int c = 0; demo.time() > 2 && c < world.fem().contacts(tyre).size(); ++c)
                    carried += double(world.fem().contacts(tyre)[c].m_impulse.y()) / kDemoStep;
            samples += demo.time() > 2;
        } while (demo.step(world.bullet()));

        demo.figure("weight", weight, "N");
        demo.figure("way", chassis.getCenterOfMassPosition().x(), "m");
        demo.check("mean force of the ground / weight", carried / std::max(samples, 1) / weight, 0.97, 1.03, "", 6);
        demo.check("speed", speed(), 0.9 * kWantedSpeed, 1.1 * kWantedSpeed, "m/s", 6);
        demo.check("lowest hub / radius of the tyre", lowest / kTyre, 0.8, 1, "");
        demo.check("largest tilt", tilt, 0, 20, "degrees");
    };
    return demo.run(argc, argv, scene);
}
