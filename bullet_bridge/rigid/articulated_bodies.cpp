// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/articulated_bodies.h"

#include <algorithm>
#include <utility>

#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr int kBase = 6;  // generalized velocities of the base

void addGravity(btMultiBody& body, const Vec3& gravity)
{
    if (dot(gravity, gravity) == 0) return;
    body.addBaseForce(body.getBaseMass() * bulletVector(gravity));
    for (int k = 0; k < body.getNumLinks(); ++k) body.addLinkForce(k, body.getLinkMass(k) * bulletVector(gravity));
}

}  // namespace

bool ArticulatedBodies::sleeps(const btMultiBody& body)
{
    const auto isAsleep = [](const btCollisionObject* collider)
    { return collider && collider->getActivationState() == ISLAND_SLEEPING; };
    bool asleep = isAsleep(body.getBaseCollider());
    for (int k = 0; k < body.getNumLinks() && !asleep; ++k) asleep = isAsleep(body.getLinkCollider(k));
    return asleep;
}

bool ArticulatedBodies::canMove(const btMultiBodyLinkCollider& link)
{
    const btMultiBody* body = link.m_multiBody;
    if (!body || link.isStaticOrKinematicObject() || link.m_link >= body->getNumLinks()) return false;
    if (!body->isAwake() && !body->getCanWakeup()) return false;
    return link.m_link < 0 ? !body->isBaseStaticOrKinematic() : true;
}

void ArticulatedBodies::beginStep()
{
    m_before.clear();
    m_beforeVelocity.clear();
    for (Memory& memory : m_memories)
    {
        if (!memory.m_used) memory.m_body = nullptr;
        memory.m_used = false;
    }
}

void ArticulatedBodies::assumeForcesGiven(const Vec3& gravity)
{
    m_forcesGiven = true;
    m_takenGravity = gravity;
}

void ArticulatedBodies::noteBeforeSolve(const btMultiBody& body)
{
    for (const Before& known : m_before)
        if (known.m_body == &body) return;
    m_before.push_back({&body, m_beforeVelocity.size()});
    const btScalar* velocity = body.getVelocityVector();
    m_beforeVelocity.insert(m_beforeVelocity.end(), velocity, velocity + kBase + body.getNumDofs());
}

void ArticulatedBodies::clear()
{
    m_trees.clear();
    m_links.clear();
    m_velocity.clear();
    m_freeVelocity.clear();
    m_jacobian.clear();
    m_answer.clear();
}

LinkMotion ArticulatedBodies::add(int index, const btMultiBodyLinkCollider& link, double step, RigidProxy& rigidProxy)
{
    int tree = find(*link.m_multiBody);
    if (tree < 0)
    {
        tree = treeOf(*link.m_multiBody);
        predict(m_trees[tree], step);
    }
    return addLink(index, link, tree, rigidProxy);
}

LinkMotion ArticulatedBodies::addBeforeSolve(int index, const btMultiBodyLinkCollider& link, RigidProxy& rigidProxy)
{
    const int known = find(*link.m_multiBody);
    return addLink(index, link, known < 0 ? treeOf(*link.m_multiBody) : known, rigidProxy);
}

LinkMotion ArticulatedBodies::addLink(int index, const btMultiBodyLinkCollider& link, int tree, RigidProxy& rigidProxy)
{
    Link added = {index, tree, link.m_link, m_jacobian.size(), {}, {}, {}, {}};
    fillRows(added, rigidProxy.m_center);
    m_links.push_back(added);
    const LinkMotion next = motion(added, m_freeVelocity);
    rigidProxy.m_linearVelocity = next.m_linear;
    rigidProxy.m_angularVelocity = next.m_angular;
    const RigidResponse own = response(added, added);
    for (int c = 0; c < 3; ++c) rigidProxy.m_inverseMass[c] = own.m_linear(c, c);
    rigidProxy.m_inverseInertia = own.m_angular;
    return motion(added, m_velocity);
}

int ArticulatedBodies::find(const btMultiBody& body) const
{
    for (std::size_t k = 0; k < m_trees.size(); ++k)
        if (m_trees[k].m_body == &body) return static_cast<int>(k);
    return -1;
}

int ArticulatedBodies::treeOf(btMultiBody& body)
{
    const Tree tree = {&body, kBase + body.getNumDofs(), m_velocity.size()};
    m_trees.push_back(tree);
    const btScalar* velocity = body.getVelocityVector();
    m_velocity.insert(m_velocity.end(), velocity, velocity + tree.m_coordinates);
    m_freeVelocity.insert(m_freeVelocity.end(), velocity, velocity + tree.m_coordinates);
    reserve(tree);
    factor(body);
    return static_cast<int>(m_trees.size()) - 1;
}

// Reserves memory that a later step may need.
void ArticulatedBodies::reserve(const Tree& tree)
{
    for (auto* values : {&m_rounded, &m_change}) values->reserve(tree.m_coordinates);
    m_force.reserve(tree.m_coordinates);
    m_turns.reserve(tree.m_body->getNumLinks() + 1);
    m_before.reserve(m_trees.size());
    m_beforeVelocity.reserve(m_velocity.size());
    memoryOf(*tree.m_body, tree.m_coordinates);
}

// Computes accelerations and the factors for impulse responses at the present pose by Bullet's articulated body
// algorithm with a time step of 0, which changes no velocity. Joint feedback is detached meanwhile, because the user
// reads it. Accelerations of kinematic joints are set to 0: Bullet does not compute them.
void ArticulatedBodies::factor(btMultiBody& body)
{
    m_feedback.resize(body.getNumLinks());
    for (int k = 0; k < body.getNumLinks(); ++k)
        m_feedback[k] = std::exchange(body.getLink(k).m_jointFeedback, nullptr);
    addGravity(body, m_takenGravity);
    body.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, m_scalars, m_vectors, m_matrices, false, false, false);
    addGravity(body, -m_takenGravity);
    for (int k = 0; k < body.getNumLinks(); ++k) body.getLink(k).m_jointFeedback = m_feedback[k];
    const btScalar* acceleration = &m_scalars[body.getNumDofs()];
    m_acceleration.assign(acceleration, acceleration + kBase + body.getNumDofs());
    for (int k = 0; k < body.getNumLinks(); ++k)
        if (body.isLinkAndAllAncestorsKinematic(k))
            std::fill_n(m_acceleration.begin() + kBase + body.getLink(k).m_dofOffset, body.getLink(k).m_dofCount, 0.0);
}

void ArticulatedBodies::predict(const Tree& tree, double step)
{
    if (sleeps(*tree.m_body)) return;
    for (int k = 0; k < tree.m_coordinates; ++k)
        if (k >= kBase || !tree.m_body->isBaseStaticOrKinematic())
            m_freeVelocity[tree.m_first + k] += step * m_acceleration[k];
    addSupport(tree, step);
}

// Adds the support by contacts, motors and limits in joint coordinates, as RigidProxies::supportOf does for rigid
// bodies.
void ArticulatedBodies::addSupport(const Tree& tree, double step)
{
    const auto before =
        std::find_if(m_before.begin(), m_before.end(), [&](const Before& b) { return b.m_body == tree.m_body; });
    if (before == m_before.end()) return;
    const double* velocity = &m_beforeVelocity[before->m_first];
    support(tree, 0, 3, velocity, step);
    support(tree, 3, 3, velocity, step);
    for (int k = kBase; k < tree.m_coordinates; ++k) support(tree, k, 1, velocity, step);
}

void ArticulatedBodies::support(const Tree& tree, int first, int count, const double* before, double step)
{
    const Memory& memory = memoryOf(*tree.m_body, tree.m_coordinates);
    const auto needed = [&](int k) { return -(step * m_acceleration[k] + memory.m_given[k]); };
    double done = 0, whole = 0;
    for (int k = first; k < first + count; ++k)
    {
        const double byForces = m_forcesGiven ? 0 : step * m_acceleration[k];
        done += (m_velocity[tree.m_first + k] - before[k] - byForces) * needed(k);
        whole += needed(k) * needed(k);
    }
    if (!(whole > 0)) return;
    const double share = std::clamp(done / whole, 0.0, 1.0);
    for (int k = first; k < first + count; ++k) m_freeVelocity[tree.m_first + k] += share * needed(k);
}

// Fills six rows of J and of J M^-1 for a link. Bullet omits joints that it does not move, and the rotation of planar
// joints, which is added here.
void ArticulatedBodies::fillRows(const Link& link, const Vec3& center)
{
    const Tree& tree = m_trees[link.m_tree];
    const btMultiBody& body = *tree.m_body;
    const std::size_t n = tree.m_coordinates;
    m_jacobian.resize(std::max(m_jacobian.size(), link.m_first + 6 * n), 0);
    m_answer.resize(m_jacobian.size(), 0);
    for (int row = 0; row < 6; ++row)
    {
        btScalar *J = &m_jacobian[link.m_first + row * n], *answer = &m_answer[link.m_first + row * n];
        btVector3 axis(0, 0, 0);
        axis[row % 3] = 1;
        const btVector3 none(0, 0, 0);
        body.fillConstraintJacobianMultiDof(link.m_index, bulletVector(center), row < 3 ? none : axis,
                                            row < 3 ? axis : none, J, m_scalars, m_vectors, m_matrices);
        for (int k = link.m_index; k >= 0 && row >= 3; k = body.getParent(k))
            if (body.getLink(k).m_jointType == btMultibodyLink::ePlanar)
                J[kBase + body.getLink(k).m_dofOffset] +=
                    body.worldDirToLocal(k, axis).dot(body.getLink(k).getAxisTop(0));
        body.calcAccelerationDeltasMultiDof(J, answer, m_scalars, m_vectors);
    }
}

LinkMotion ArticulatedBodies::motion(const Link& link, const std::vector<double>& velocity) const
{
    const Tree& tree = m_trees[link.m_tree];
    double sums[6] = {};
    for (int row = 0; row < 6; ++row)
        for (int k = 0; k < tree.m_coordinates; ++k)
            sums[row] += double(m_jacobian[link.m_first + row * tree.m_coordinates + k]) * velocity[tree.m_first + k];
    return {{sums[0], sums[1], sums[2]}, {sums[3], sums[4], sums[5]}};
}

Mat3 ArticulatedBodies::block(const Link& moved, int rowOfMoved, const Link& pushed, int rowOfPushed) const
{
    const int n = m_trees[moved.m_tree].m_coordinates;
    Mat3 result;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < n; ++k)
                result(i, j) += double(m_jacobian[moved.m_first + (rowOfMoved + i) * n + k]) *
                                double(m_answer[pushed.m_first + (rowOfPushed + j) * n + k]);
    return result;
}

RigidResponse ArticulatedBodies::response(const Link& moved, const Link& pushed) const
{
    return {moved.m_rigidProxy, block(moved, 0, pushed, 0), block(moved, 0, pushed, 3), block(moved, 3, pushed, 0),
            block(moved, 3, pushed, 3)};
}

void ArticulatedBodies::setCenter(int index, const Vec3& center)
{
    for (const Link& link : m_links)
        if (link.m_rigidProxy == index) fillRows(link, center);
}

void ArticulatedBodies::connect(std::vector<RigidProxy>& rigidProxies, std::vector<RigidResponse>& responses) const
{
    responses.clear();
    for (const Link& pushed : m_links)
    {
        RigidProxy& rigidProxy = rigidProxies[pushed.m_rigidProxy];
        rigidProxy.m_firstResponse = static_cast<int>(responses.size());
        for (const Link& moved : m_links)
            if (moved.m_tree == pushed.m_tree) responses.push_back(response(moved, pushed));
        rigidProxy.m_responseCount = static_cast<int>(responses.size()) - rigidProxy.m_firstResponse;
    }
}

}  // namespace bullet_fem
