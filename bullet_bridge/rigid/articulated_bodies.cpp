// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/articulated_bodies.h"

#include <algorithm>

#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{

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
    const int tree = treeOf(*link.m_multiBody, step);
    Link& added = addLink(index, tree, link.m_link);
    m_dynamics.fillRows(*link.m_multiBody, added.m_index, rigidProxy.m_center, &m_jacobian[added.m_first],
                        &m_answer[added.m_first]);
    setProxy(added, rigidProxy);
    return motion(added, m_velocity);
}

ArticulatedBodies::Link& ArticulatedBodies::addLink(int index, int tree, int link)
{
    m_links.push_back({index, tree, link, m_jacobian.size(), {}, {}, {}, {}});
    m_jacobian.resize(m_jacobian.size() + 6 * m_trees[tree].m_coordinates, 0);
    m_answer.resize(m_jacobian.size(), 0);
    return m_links.back();
}

// Predicted velocity, and the response to impulses.
void ArticulatedBodies::setProxy(const Link& link, RigidProxy& rigidProxy) const
{
    const LinkMotion next = motion(link, m_freeVelocity);
    rigidProxy.m_linearVelocity = next.m_linear;
    rigidProxy.m_angularVelocity = next.m_angular;
    const RigidResponse own = response(link, link);
    for (int c = 0; c < 3; ++c) rigidProxy.m_inverseMass[c] = own.m_linear(c, c);
    rigidProxy.m_inverseInertia = own.m_angular;
}

// Index of a multibody, which is added at the first call; with its predicted velocity if `step` is not 0.
int ArticulatedBodies::treeOf(btMultiBody& body, double step)
{
    const auto known = std::find_if(m_trees.begin(), m_trees.end(), [&](const Tree& t) { return t.m_body == &body; });
    if (known != m_trees.end()) return static_cast<int>(known - m_trees.begin());
    const Tree tree = {&body, kBaseCoordinates + body.getNumDofs(), m_velocity.size(), false};
    m_trees.push_back(tree);
    const btScalar* velocity = body.getVelocityVector();
    m_velocity.insert(m_velocity.end(), velocity, velocity + tree.m_coordinates);
    m_freeVelocity.insert(m_freeVelocity.end(), velocity, velocity + tree.m_coordinates);
    for (auto* values : {&m_impulse, &m_change}) values->reserve(tree.m_coordinates);
    m_force.reserve(tree.m_coordinates);
    m_history.reserve(body, m_trees.size(), m_velocity.size());
    m_dynamics.factor(body);
    if (step > 0 && !sleeps(body))
    {
        const std::vector<double>& acceleration = m_dynamics.acceleration();
        for (int k = body.isBaseStaticOrKinematic() ? kBaseCoordinates : 0; k < tree.m_coordinates; ++k)
            m_freeVelocity[tree.m_first + k] += step * acceleration[k];
        m_trees.back().m_isFree =
            m_history.addSupport(body, step, acceleration, &m_velocity[tree.m_first], &m_freeVelocity[tree.m_first]);
    }
    return static_cast<int>(m_trees.size()) - 1;
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

RigidResponse ArticulatedBodies::response(const Link& moved, const Link& pushed) const
{
    const int n = m_trees[moved.m_tree].m_coordinates;
    const auto block = [&](int rowOfMoved, int rowOfPushed)
    {
        Mat3 result;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                for (int k = 0; k < n; ++k)
                    result(i, j) += double(m_jacobian[moved.m_first + (rowOfMoved + i) * n + k]) *
                                    double(m_answer[pushed.m_first + (rowOfPushed + j) * n + k]);
        return result;
    };
    return {moved.m_rigidProxy, block(0, 0), block(0, 3), block(3, 0), block(3, 3)};
}

void ArticulatedBodies::setCenter(int index, const Vec3& center)
{
    for (const Link& link : m_links)
        if (link.m_rigidProxy == index)
            m_dynamics.fillRows(*m_trees[link.m_tree].m_body, link.m_index, center, &m_jacobian[link.m_first],
                                &m_answer[link.m_first]);
}

void ArticulatedBodies::addRows(int index, btMultiBody& body, const std::array<const btScalar*, 3>& jacobians,
                                const std::array<const btScalar*, 3>& answers, RigidProxy& rigidProxy)
{
    const Link& added = addLink(index, treeOf(body, 0), -1);
    const std::size_t n = m_trees[added.m_tree].m_coordinates;
    for (std::size_t row = 0; row < jacobians.size(); ++row)
    {
        if (!jacobians[row]) continue;
        std::copy_n(jacobians[row], n, &m_jacobian[added.m_first + row * n]);
        std::copy_n(answers[row], n, &m_answer[added.m_first + row * n]);
    }
    setProxy(added, rigidProxy);
}

void ArticulatedBodies::addBetween(int index, const btMultiBodyLinkCollider& a, const Vec3& point,
                                   const btMultiBodyLinkCollider& b, RigidProxy& rigidProxy)
{
    btMultiBody& body = *a.m_multiBody;
    const Link& added = addLink(index, treeOf(body, 0), a.m_link);
    const std::size_t size = m_jacobian.size() - added.m_first;
    m_other.assign(size, 0);
    m_otherAnswer.assign(size, 0);
    m_dynamics.fillRows(body, a.m_link, point, &m_jacobian[added.m_first], &m_answer[added.m_first]);
    m_dynamics.fillRows(body, b.m_link, rigidProxy.m_center, &m_other[0], &m_otherAnswer[0]);
    for (std::size_t k = 0; k < size; ++k)
    {
        m_jacobian[added.m_first + k] -= m_other[k];
        m_answer[added.m_first + k] -= m_otherAnswer[k];
    }
    setProxy(added, rigidProxy);
}

void ArticulatedBodies::letGo(int first, const std::vector<RigidProxy>& rigidProxies)
{
    for (Link& link : m_links)
    {
        if (link.m_rigidProxy < first) continue;
        link.m_push = rigidProxies[link.m_rigidProxy].m_pushImpulse;
        link.m_angularPush = rigidProxies[link.m_rigidProxy].m_pushAngularImpulse;
        link.m_rigidProxy = -1;
    }
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

bool ArticulatedBodies::isFree(int index) const
{
    return std::any_of(m_links.begin(), m_links.end(),
                       [&](const Link& link) { return link.m_rigidProxy == index && m_trees[link.m_tree].m_isFree; });
}

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
    for (Link& link : m_links)
        if (link.m_rigidProxy >= 0) link.m_angularImpulse += rigidProxies[link.m_rigidProxy].m_angularImpulse;
    for (std::size_t k = 0; k < m_trees.size(); ++k)
    {
        const Tree& tree = m_trees[k];
        if (solve(tree, static_cast<int>(k), nullptr))
        {
            m_history.addVelocity(*tree.m_body, m_change);
            m_history.noteGiven(*tree.m_body, m_change);
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
        const RigidProxy* proxy = pushed && link.m_rigidProxy >= 0 ? &(*pushed)[link.m_rigidProxy] : nullptr;
        const Vec3 impulse = proxy ? proxy->m_pushImpulse : pushed ? link.m_push : link.m_impulse;
        const Vec3 angular = proxy ? proxy->m_pushAngularImpulse : pushed ? link.m_angularPush : link.m_angularImpulse;
        for (int row = 0; row < 6; ++row)
            for (int k = 0; k < n; ++k)
                m_force[k] +=
                    double(m_jacobian[link.m_first + row * n + k]) * (row < 3 ? impulse[row] : angular[row - 3]);
    }
    if (std::all_of(m_force.begin(), m_force.end(), [](double f) { return f == 0; })) return false;
    m_impulse.assign(m_force.begin(), m_force.end());
    m_dynamics.respond(*tree.m_body, &m_impulse[0], &m_change[0]);
    return true;
}

// Moves the joints by m_change as their velocity for one step. Momentum depends on the pose, so a multibody with a free
// base gets the lost momentum back at the base.
void ArticulatedBodies::displace(const Tree& tree, double step)
{
    btMultiBody& body = *tree.m_body;
    const MultiBodyDynamics::Momentum before = m_dynamics.momentumOf(body);
    m_dynamics.displace(body, m_change, step);
    if (body.isBaseStaticOrKinematic()) return;
    m_dynamics.factor(body);
    const MultiBodyDynamics::Momentum after = m_dynamics.momentumOf(body);
    const Vec3 lost = before.m_linear - after.m_linear;
    const Vec3 lostSpin = before.m_angular - after.m_angular - cross(vec3(body.getBasePos()), lost);
    m_impulse.assign(tree.m_coordinates, 0);
    for (int c = 0; c < 3; ++c)
    {
        m_impulse[c] = static_cast<btScalar>(lostSpin[c]);
        m_impulse[3 + c] = static_cast<btScalar>(lost[c]);
    }
    m_change.assign(tree.m_coordinates, 0);
    m_dynamics.respond(body, &m_impulse[0], &m_change[0]);
    m_history.addVelocity(body, m_change);
}

}  // namespace bullet_fem
