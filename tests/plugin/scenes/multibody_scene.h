// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/link_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{

inline const btVector3 kNoGravity(0, 0, 0);
inline const btQuaternion kNoTurn = btQuaternion::getIdentity();

/// Principal moments of inertia of a box with these half edges [kg m2].
inline btVector3 boxInertia(btScalar mass, const btVector3& half)
{
    btVector3 inertia;
    btBoxShape(half).calculateLocalInertia(mass, inertia);
    return inertia;
}

/// Momenta of all links and of the base if it is movable.
inline Motion motionOfLinks(btMultiBody& body)
{
    Motion sum;
    const int count = body.getNumLinks() + 1;
    std::vector<btVector3> spin(count), velocity(count);
    body.compTreeLinkVelocities(&spin[0], &velocity[0]);
    for (int k = body.hasFixedBase() ? 0 : -1; k < body.getNumLinks(); ++k)
    {
        const double mass = k < 0 ? body.getBaseMass() : body.getLinkMass(k);
        const btVector3 inertia = k < 0 ? body.getBaseInertia() : body.getLinkInertia(k);
        const Vec3 p = mass * vec3(body.localDirToWorld(k, velocity[k + 1]));
        const Vec3 c = vec3(body.localPosToWorld(k, btVector3(0, 0, 0)));
        const btVector3 L = inertia * spin[k + 1];
        sum.m_linear += p;
        sum.m_angular += cross(c, p) + vec3(body.localDirToWorld(k, L));
        sum.m_energy += 0.5 * mass * velocity[k + 1].length2() + 0.5 * L.dot(spin[k + 1]);
    }
    return sum;
}

/// Fixture with sliders, pendulums and soft cubes.
class MultiBodyWorldTest : public ::testing::Test
{
protected:
    explicit MultiBodyWorldTest(const btFemSolverInfo& info = btFemSolverInfo()) : m_fem(info) {}

    // A box on a slider along `axis` whose joint is at the world's origin; the box starts at `center`.
    btMultiBodyLinkCollider& addSlider(MultiBodyWorld& world, btScalar mass, const btVector3& axis,
                                       const btVector3& half, const btVector3& center)
    {
        auto* body = new btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
        body->setupPrismatic(0, mass, boxInertia(mass, half), -1, kNoTurn, axis, center, btVector3(0, 0, 0), false);
        return world.addCollider(world.addMultiBody(body), 0, new btBoxShape(half));
    }

    // A beam on a hinge along y at the origin; `half` are the half edges of its box.
    btMultiBodyLinkCollider& addPendulum(MultiBodyWorld& world, btScalar mass, const btVector3& half)
    {
        auto* body = new btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
        body->setupRevolute(0, mass, boxInertia(mass, half), -1, kNoTurn, btVector3(0, 1, 0), btVector3(0, 0, 0),
                            btVector3(0, 0, -half.z()), false);
        return world.addCollider(world.addMultiBody(body), 0, new btBoxShape(half));
    }

    btSoftBody& addCube(MultiBodyWorld& world, const Vec3& center, double edge = 0.4, double friction = 0.5)
    {
        SoftBox box;
        box.m_size = {edge, edge, edge};
        box.m_center = center;
        box.m_friction = btScalar(friction);
        return world.addSoft(makeSoftBox(world.info(), m_fem, box));
    }

    btFemSoftBodySolver m_fem;
};

}  // namespace bullet_fem
