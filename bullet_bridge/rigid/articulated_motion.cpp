// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// ArticulatedBodies: applies impulses and position corrections to multibodies.
#include <algorithm>
#include <cmath>

#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "bullet_bridge/rigid/articulated_bodies.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

void setVelocity(btMultiBody& body, const std::vector<btScalar>& velocity)
{
    body.setBaseOmega(btVector3(velocity[0], velocity[1], velocity[2]));
    body.setBaseVel(btVector3(velocity[3], velocity[4], velocity[5]));
    for (int k = 0; k < body.getNumLinks(); ++k)
    {
        const btMultibodyLink& link = body.getLink(k);
        for (int d = 0; d < link.m_dofCount; ++d) body.getJointVelMultiDof(k)[d] = velocity[6 + link.m_dofOffset + d];
    }
}

// A multibody that is only about to sleep decides by its own motion.
void wakeIfAsleep(btMultiBody& body)
{
    if (!ArticulatedBodies::sleeps(body)) return;
    body.wakeUp();
    const auto activate = [](btCollisionObject* collider)
    {
        if (collider && !collider->isActive()) collider->activate();
    };
    activate(body.getBaseCollider());
    for (int k = 0; k < body.getNumLinks(); ++k) activate(body.getLinkCollider(k));
}

}  // namespace

void ArticulatedBodies::addImpulse(int index, const Vec3& impulse, const Vec3& angular)
{
    for (Link& link : m_links)
    {
        if (link.m_rigidProxy != index) continue;
        link.m_impulse += impulse;
        link.m_angularImpulse += angular;
    }
}

void ArticulatedBodies::apply(const std::vector<RigidProxy>& rigidProxies, double step)
{
    for (Link& link : m_links) link.m_angularImpulse += rigidProxies[link.m_rigidProxy].m_angularImpulse;
    for (std::size_t k = 0; k < m_trees.size(); ++k)
    {
        const Tree& tree = m_trees[k];
        if (solve(tree, static_cast<int>(k), nullptr))
        {
            addVelocity(tree);
            memoryOf(*tree.m_body, tree.m_coordinates).m_given.assign(m_change.begin(), m_change.end());
            wakeIfAsleep(*tree.m_body);
        }
        if (solve(tree, static_cast<int>(k), &rigidProxies)) displace(tree, step);
    }
}

// Solves for the change of a tree's coordinates by the impulses on its links, or by their position corrections if
// `pushed` is given. False if all are 0.
bool ArticulatedBodies::solve(const Tree& tree, int number, const std::vector<RigidProxy>* pushed)
{
    const int n = tree.m_coordinates;
    m_force.assign(n, 0);
    m_change.assign(n, 0);
    for (const Link& link : m_links)
    {
        if (link.m_tree != number) continue;
        const Vec3 impulse = pushed ? (*pushed)[link.m_rigidProxy].m_pushImpulse : link.m_impulse;
        const Vec3 angular = pushed ? (*pushed)[link.m_rigidProxy].m_pushAngularImpulse : link.m_angularImpulse;
        for (int row = 0; row < 6; ++row)
            for (int k = 0; k < n; ++k)
                m_force[k] +=
                    double(m_jacobian[link.m_first + row * n + k]) * (row < 3 ? impulse[row] : angular[row - 3]);
    }
    if (std::all_of(m_force.begin(), m_force.end(), [](double f) { return f == 0; })) return false;
    m_rounded.assign(m_force.begin(), m_force.end());
    tree.m_body->calcAccelerationDeltasMultiDof(&m_rounded[0], &m_change[0], m_scalars, m_vectors);
    return true;
}

void ArticulatedBodies::addVelocity(const Tree& tree)
{
    Memory& memory = memoryOf(*tree.m_body, tree.m_coordinates);
    memory.m_used = true;
    const btScalar* now = tree.m_body->getVelocityVector();
    const btScalar fastest = tree.m_body->getMaxCoordinateVelocity();
    m_rounded.resize(tree.m_coordinates);
    for (int k = 0; k < tree.m_coordinates; ++k)
    {
        const double exact = double(now[k]) + memory.m_remainder[k] + double(m_change[k]);
        m_rounded[k] = std::clamp(static_cast<btScalar>(exact), -fastest, fastest);
        memory.m_remainder[k] = std::abs(exact) < double(fastest) ? exact - double(m_rounded[k]) : 0;
    }
    setVelocity(*tree.m_body, m_rounded);
}

// Moves the joints by m_change as their velocity for one step. It is set as the multibody's own velocity meanwhile,
// because stepPositionsMultiDof() ignores velocities passed to it in planar joints. Momentum depends on the pose, so a
// multibody with a free base gets the lost momentum back at the base.
void ArticulatedBodies::displace(const Tree& tree, double step)
{
    btMultiBody& body = *tree.m_body;
    const Momentum before = momentum(body);
    const btScalar* now = body.getVelocityVector();
    m_rounded.assign(now, now + tree.m_coordinates);
    setVelocity(body, m_change);
    body.stepPositionsMultiDof(static_cast<btScalar>(step));
    setVelocity(body, m_rounded);
    body.updateCollisionObjectWorldTransforms(m_turns, m_vectors);
    if (body.isBaseStaticOrKinematic()) return;
    factor(body);
    const Momentum after = momentum(body);
    const Vec3 lost = before.m_linear - after.m_linear;
    const Vec3 lostSpin = before.m_angular - after.m_angular - cross(vec3(body.getBasePos()), lost);
    m_rounded.assign(tree.m_coordinates, 0);
    for (int c = 0; c < 3; ++c)
    {
        m_rounded[c] = static_cast<btScalar>(lostSpin[c]);
        m_rounded[3 + c] = static_cast<btScalar>(lost[c]);
    }
    m_change.assign(tree.m_coordinates, 0);
    body.calcAccelerationDeltasMultiDof(&m_rounded[0], &m_change[0], m_scalars, m_vectors);
    addVelocity(tree);
}

// Momentum of base and links: linear [kg m/s], and angular about the world's origin [kg m2/s].
ArticulatedBodies::Momentum ArticulatedBodies::momentum(const btMultiBody& body)
{
    const int count = body.getNumLinks() + 1;
    m_vectors.resize(2 * count);
    body.compTreeLinkVelocities(&m_vectors[0], &m_vectors[count]);
    Momentum sum;
    for (int k = -1; k < body.getNumLinks(); ++k)
    {
        const btVector3 inertia = k < 0 ? body.getBaseInertia() : body.getLinkInertia(k);
        const double mass = k < 0 ? body.getBaseMass() : body.getLinkMass(k);
        const Vec3 p = mass * vec3(body.localDirToWorld(k, m_vectors[count + k + 1]));
        sum.m_linear += p;
        sum.m_angular += cross(vec3(body.localPosToWorld(k, btVector3(0, 0, 0))), p) +
                         vec3(body.localDirToWorld(k, inertia * m_vectors[k + 1]));
    }
    return sum;
}

ArticulatedBodies::Memory& ArticulatedBodies::memoryOf(const btMultiBody& body, int coordinates)
{
    const auto find = [this](const btMultiBody* wanted)
    {
        return std::find_if(m_memories.begin(), m_memories.end(),
                            [wanted](const Memory& m) { return m.m_body == wanted; });
    };
    auto memory = find(&body);
    if (memory != m_memories.end() && static_cast<int>(memory->m_given.size()) == coordinates) return *memory;
    if (memory == m_memories.end()) memory = find(nullptr);
    if (memory == m_memories.end()) memory = m_memories.insert(m_memories.end(), Memory());
    memory->m_body = &body;
    memory->m_given.assign(coordinates, 0);
    memory->m_remainder.assign(coordinates, 0);
    return *memory;
}

}  // namespace bullet_fem
