// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <array>
#include <cmath>

#include "benchmarks/games/game_scene.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

constexpr double kTyre = 0.4, kHub = 0.16, kWidth = 0.25;  // radii and width of a wheel [m]
constexpr double kWantedSpeed = 4;                         // [m/s]
constexpr double kMaxTorque = 120;                         // of the motor on each wheel [N m]

btVector3 place(double x, double y, double z)
{
    return {btScalar(x), btScalar(y), btScalar(z)};
}

// A cylinder around z; its inner nodes are anchored to the hub.
void addTyre(GameWorld& world, btRigidBody& hub)
{
    const btVector3 centre = hub.getWorldTransform().getOrigin();
    btSoftBody* tyre = btFemHelpers::createFromTetMesh(world.info(), makeCylinder(kTyre, kWidth, 8, 2));
    tyre->translate(centre);
    for (int i = 0; i < tyre->m_nodes.size(); ++i)
    {
        const btVector3 r = tyre->m_nodes[i].m_x - centre;
        if (std::hypot(r.x(), r.y()) < kHub) tyre->appendAnchor(i, &hub, true);
    }
    world.addSoft(tyre, 4e5, 300, 1);
}

// A long bump under both wheels, then shorter ones, left and right alternately; 8 cm high.
void addBumps(GameWorld& world)
{
    for (int k = 0; k < 6; ++k)
    {
        const double radius = 0.5, half = k == 0 ? 1.5 : 0.6, side = k == 0 ? 0 : k % 2 == 1 ? 0.75 : -0.75;
        auto* shape = new btCylinderShapeZ(place(radius, radius, half));
        world.addRigid(shape, 0, place(6 + 1.5 * k, 0.08 - radius, side), 1);
    }
}

void buildCar(GameWorld& world)
{
    world.addRigid(new btStaticPlaneShape(place(0, 1, 0), 0), 0, place(0, 0, 0), 1);
    addBumps(world);
    btRigidBody& chassis = world.addRigid(new btBoxShape(place(1.1, 0.16, 0.45)), 400, place(0, kTyre + 0.12, 0), 1);
    chassis.setActivationState(DISABLE_DEACTIVATION);
    std::vector<btRigidBody*> hubs;
    for (const double x : {-0.8, 0.8})
        for (const double z : {-0.75, 0.75})
        {
            const btVector3 centre = place(x, kTyre, z), axis(0, 0, 1);
            btRigidBody& hub = world.addRigid(new btCylinderShapeZ(place(kHub, kHub, 0.6 * kWidth)), 30, centre, 1);
            world.addJoint(new btHingeConstraint(chassis, hub, centre - chassis.getCenterOfMassPosition(),
                                                 place(0, 0, 0), axis, axis));
            addTyre(world, hub);
            hubs.push_back(&hub);
        }
    world.setDrive(
        [&chassis, hubs](GameWorld&, double)
        {
            const double missing = kWantedSpeed - double(chassis.getLinearVelocity().x());
            const btVector3 torque = place(0, 0, -kMaxTorque * std::clamp(2 * missing, -1.0, 1.0));
            for (btRigidBody* hub : hubs)
            {
                hub->applyTorque(torque);
                chassis.applyTorque(-torque);
            }
        });
}

}  // namespace

GameScene car()
{
    return sceneOf("car", 360, 1, true, buildCar);
}

}  // namespace bullet_fem
