// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/body/rigid_momentum.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/body/rigid_sums.h"
#include "fem/body/step_scratch.h"
#include "fem/factor/rest_modes.h"

namespace bullet_fem
{
namespace
{

// Maximum distance of fixed nodes from their common point or line, as a share of the component's size [-].
constexpr double kCollinearShare = 1e-4;

// Reference positions of levers: with x+ = y + h theta v+, only the part of the end angular momentum with the positions
// y depends on the end velocities.
const std::vector<Vec3>& leverPositions(const Body& body)
{
    return body.m_workspace.scratch().m_kickPosition;
}

}  // namespace

// Mass and centre of every component: the centre of mass, or the first fixed node and the vector to the farthest one.
void RigidMomentum::findCenters(const Body& body, const std::vector<Vec3>& x)
{
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    const BodyState& s = body.m_state;
    for (Component& component : m_components) component = Component();
    for (std::size_t i = 0; i < x.size(); ++i)
    {
        Component& component = m_components[componentOf[i]];
        if (!s.m_fixed[i]) continue;
        if (component.m_pivot < 0) component.m_pivot = static_cast<int>(i);
        const Vec3 r = x[i] - x[component.m_pivot];
        if (dot(r, r) > dot(component.m_axis, component.m_axis)) component.m_axis = r;
    }
    forEachNode(componentOf, m_components,
                [&](Component& component, int i)
                {
                    component.m_mass += s.m_mass[i];
                    component.m_center += s.m_mass[i] * x[i];
                });
    for (Component& component : m_components)
        component.m_center = component.m_pivot < 0 ? (1 / component.m_mass) * component.m_center : x[component.m_pivot];
}

// Determines the movable components, for which it replaces the inertia in m_inverseInertia by its inverse. A component
// with fixed nodes is clamped if one lies off the point or line of the others, or moves differently.
void RigidMomentum::findMovable(const Body& body, double step, const std::vector<Vec3>& x)
{
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    const auto slack = [](const Component& component)
    { return kCollinearShare * std::sqrt(trace(component.m_inverseInertia) / component.m_mass); };
    for (Component& component : m_components)
        if (norm(component.m_axis) <= slack(component)) component.m_axis = {};
    for (std::size_t i = 0; i < x.size(); ++i)
    {
        Component& component = m_components[componentOf[i]];
        if (!body.m_state.m_fixed[i]) continue;
        const Vec3 r = x[i] - component.m_center;
        const double length2 = dot(component.m_axis, component.m_axis);
        const Vec3 beside = length2 > 0 ? r - (dot(r, component.m_axis) / length2) * component.m_axis : r;
        const std::vector<Vec3>& target = body.m_loads.m_targetVelocity;
        const double apart = step * norm(target[i] - target[component.m_pivot]);
        if (std::max(norm(beside), apart) > slack(component)) component.m_isMovable = false;
    }
    m_anyMovable = false;
    for (Component& component : m_components)
    {
        if (!component.m_isMovable) continue;
        m_anyMovable = true;
        if (component.m_pivot < 0)
        {
            component.m_inverseInertia =
                inverseInertia(component.m_inverseInertia, component.m_mass, component.m_center);
            continue;
        }
        const double aboutAxis = dot(component.m_axis, component.m_inverseInertia * component.m_axis);
        component.m_inverseInertia = aboutAxis > 0 ? (1 / aboutAxis) * outer(component.m_axis, component.m_axis)
                                                   : boundedInverse(component.m_inverseInertia, 0);
        component.m_mass = std::numeric_limits<double>::infinity();
    }
    const std::vector<RestModes::Component>& rest = body.m_model->restModes().components();
    m_hasRestModes = body.m_model->restModes().any() && body.m_state.m_fixed == body.m_model->factorInput().m_fixed;
    for (std::size_t c = 0; c < m_components.size(); ++c)
        m_hasRestModes = m_hasRestModes && (m_components[c].m_isMovable || !rest[c].moves());
}

void RigidMomentum::prescribe(const Body& body, double step)
{
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    const BodyState& s = body.m_state;
    const std::vector<Vec3>&x = leverPositions(body), &v = body.m_workspace.scratch().m_kickVelocity;
    findCenters(body, x);
    const double alpha = damping(body), toFrame = body.m_loads.m_frameDamping;
    const double share = step / (1 + step * (alpha + toFrame));
    m_impulseShare = 1 / (1 + step * alpha);
    for (Component& component : m_components)
        if (component.m_pivot >= 0) component.m_carried = body.m_loads.m_targetVelocity[component.m_pivot];
    forEachNode(componentOf, m_components,
                [&](Component& component, int i)
                {
                    const Vec3 r = x[i] - component.m_center, p = s.m_mass[i] * v[i];
                    Vec3 force = body.m_loads.m_force[i] - alpha * p;
                    if (toFrame > 0) force += toFrame * (s.m_mass[i] * body.m_loads.m_frameVelocity[i] - p);
                    const Vec3 prescribed = p + share * force - s.m_mass[i] * component.m_carried;
                    if (component.m_pivot >= 0)
                        component.m_angularBefore += cross(r, p - s.m_mass[i] * component.m_carried);
                    component.m_linear += prescribed;
                    component.m_angular += cross(r, prescribed);
                    component.m_inverseInertia += s.m_mass[i] * (Mat3::diagonal(dot(r, r)) - outer(r, r));
                });
    findMovable(body, step, x);
}

double RigidMomentum::damping(const Body& body)
{
    return body.m_model->shape().m_material.m_massDamping + body.m_loads.m_massDamping;
}

Mat3 RigidMomentum::inverseInertia(const Mat3& inertia, double mass, const Vec3& center)
{
    return boundedInverse(inertia, 1e-24 * mass * dot(center, center));
}

RigidMomentum::FreeComponent RigidMomentum::onlyComponent() const
{
    const Component& component = m_components.front();
    return {component.m_mass, component.m_center, component.m_linear, component.m_angular, component.m_inverseInertia};
}

void RigidMomentum::setOnlyComponent(const FreeComponent& free, double impulseShare)
{
    m_anyMovable = m_hasRestModes = true;
    m_impulseShare = impulseShare;
    Component& component = m_components.front();
    component = Component();
    component.m_mass = free.m_mass;
    component.m_center = free.m_center;
    component.m_linear = free.m_linear;
    component.m_angular = free.m_angular;
    component.m_inverseInertia = free.m_inverseInertia;
}

void RigidMomentum::addImpulses(const Body& body, const std::vector<Vec3>& impulses, double step)
{
    if (!m_anyMovable) return;
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    const std::vector<Vec3>& x = leverPositions(body);
    const double share = 1 / (1 + step * damping(body));
    for (std::size_t i = 0; i < impulses.size(); ++i)
    {
        Component& component = m_components[componentOf[i]];
        component.m_linear += share * impulses[i];
        component.m_angular += cross(x[i] - component.m_center, share * impulses[i]);
    }
}

void RigidMomentum::addAngularImpulse(const Body& body, int node, const Vec3& impulse, double step)
{
    const int component = body.m_model->mesh().nodeComponent()[node];
    const Vec3 added = (1 / (1 + step * damping(body))) * impulse;
    m_components[component].m_angular += added;
    m_added[component] += added;
}

void RigidMomentum::clearAngularImpulses()
{
    std::fill(m_added.begin(), m_added.end(), Vec3());
}

void RigidMomentum::repeatAngularImpulses()
{
    for (std::size_t c = 0; c < m_components.size(); ++c) m_components[c].m_angular += m_added[c];
}

void RigidMomentum::restore(const Body& body, std::vector<Vec3>& velocity)
{
    if (!m_anyMovable) return;
    const std::vector<Vec3>& x = leverPositions(body);
    for (Component& component : m_components)
    {
        component.m_linearVelocity = component.m_linear;
        component.m_angularVelocity = component.m_angular;
    }
    addRigid(body, x, true, velocity);
}

void RigidMomentum::clearMotions() const
{
    for (Component& component : m_components) component.m_linearVelocity = component.m_angularVelocity = {};
}

// Velocities of the components with these momenta, which are in their place on entry.
void RigidMomentum::findMotions() const
{
    for (Component& component : m_components)
    {
        component.m_linearVelocity *= 1 / component.m_mass;
        component.m_angularVelocity = component.m_inverseInertia * component.m_angularVelocity;
    }
}

void RigidMomentum::removeMotion(const Body& body, std::vector<Vec3>& change) const
{
    if (!m_anyMovable) return;
    clearMotions();
    addRigid(body, leverPositions(body), false, change);
}

void RigidMomentum::removeRigidVelocity(const Body& body, std::vector<Vec3>& velocity) const
{
    if (!m_anyMovable) return;
    clearMotions();
    addRigid(body, leverPositions(body), true, velocity);
}

// The resultants of impulses on the free nodes, in place of the components' velocities.
void RigidMomentum::sumImpulses(const Body& body, const std::vector<Vec3>& impulses) const
{
    const std::vector<Vec3>& x = leverPositions(body);
    clearMotions();
    forEachNode(body.m_model->mesh().nodeComponent(), m_components,
                [&](Component& component, int i)
                {
                    if (body.m_state.m_fixed[i]) return;
                    component.m_linearVelocity += impulses[i];
                    component.m_angularVelocity += cross(x[i] - component.m_center, impulses[i]);
                });
}

void RigidMomentum::removeImpulses(const Body& body, std::vector<Vec3>& impulses) const
{
    if (!m_anyMovable) return;
    const std::vector<Vec3>& x = leverPositions(body);
    sumImpulses(body, impulses);
    findMotions();
    forEachNode(body.m_model->mesh().nodeComponent(), m_components,
                [&](const Component& component, int i)
                {
                    if (component.m_isMovable && !body.m_state.m_fixed[i])
                        impulses[i] -=
                            body.m_state.m_mass[i] * (component.m_linearVelocity +
                                                      cross(component.m_angularVelocity, x[i] - component.m_center));
                });
}

void RigidMomentum::addResponse(const Body& body, const std::vector<Vec3>& impulses, std::vector<Vec3>& change) const
{
    if (!m_anyMovable) return;
    const std::vector<Vec3>& x = leverPositions(body);
    sumImpulses(body, impulses);
    findMotions();
    forEachNode(body.m_model->mesh().nodeComponent(), m_components,
                [&](const Component& component, int i)
                {
                    if (component.m_isMovable && !body.m_state.m_fixed[i])
                        change[i] += m_impulseShare * (component.m_linearVelocity +
                                                       cross(component.m_angularVelocity, x[i] - component.m_center));
                });
}

// Adds the rigid motion with the missing momentum: the momenta to reach are in the components' velocities on entry.
// `fromCarried`: of velocities relative to those of the fixed nodes.
void RigidMomentum::addRigid(const Body& body, const std::vector<Vec3>& x, bool fromCarried,
                             std::vector<Vec3>& velocity) const
{
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    const BodyState& s = body.m_state;
    forEachNode(componentOf, m_components,
                [&](Component& component, int i)
                {
                    const Vec3 p = s.m_mass[i] * (fromCarried ? velocity[i] - component.m_carried : velocity[i]);
                    component.m_linearVelocity -= p;
                    component.m_angularVelocity -= cross(x[i] - component.m_center, p);
                });
    findMotions();
    forEachNode(componentOf, m_components,
                [&](const Component& component, int i)
                {
                    if (component.m_isMovable && !s.m_fixed[i])
                        velocity[i] +=
                            component.m_linearVelocity + cross(component.m_angularVelocity, x[i] - component.m_center);
                });
}

RigidMomentum::Share RigidMomentum::shareOf(const Body& body, const int* nodes, const Mat3* blocks, int count) const
{
    Share share;
    const std::vector<Vec3>& x = leverPositions(body);
    for (int k = 0; k < count; ++k)
    {
        const int i = nodes[k];
        if (body.m_state.m_fixed[i]) continue;
        share.m_component = body.m_model->mesh().nodeComponent()[i];
        const Mat3 impulses = transpose(blocks[k]);
        share.m_linear += impulses;
        share.m_angular += crossMatrix(x[i] - m_components[share.m_component].m_center) * impulses;
    }
    return share;
}

RigidMomentum::Share RigidMomentum::responseTo(const Share& share) const
{
    if (share.m_component < 0 || !m_components[share.m_component].m_isMovable) return {};
    const Component& component = m_components[share.m_component];
    return {share.m_component, m_impulseShare / component.m_mass * share.m_linear,
            m_impulseShare * (component.m_inverseInertia * share.m_angular)};
}

Vec3 RigidMomentum::spin(const Component& component) const
{
    const bool hangs = component.m_pivot >= 0;
    return component.m_inverseInertia *
           (hangs ? 0.5 * (component.m_angularBefore + component.m_angular) : component.m_angular);
}

double RigidMomentum::fastestSpin() const
{
    double fastest = 0;
    for (const Component& component : m_components)
        if (m_anyMovable && component.m_isMovable)
            fastest = std::max(fastest, norm(component.m_inverseInertia * component.m_angular));
    return fastest;
}

void RigidMomentum::addInward(const Body& body, double factor, std::vector<Vec3>& change) const
{
    if (!m_anyMovable) return;
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    const std::vector<Vec3>& x = leverPositions(body);
    for (Component& component : m_components) component.m_angularVelocity = spin(component);
    for (std::size_t i = 0; i < x.size(); ++i)
    {
        const Component& component = m_components[componentOf[i]];
        if (!component.m_isMovable) continue;
        const Vec3& w = component.m_angularVelocity;
        change[i] += factor * cross(w, cross(w, x[i] - component.m_center));
    }
}

void RigidMomentum::addCentrifugal(const Body& body, double step, std::vector<Vec3>& b) const
{
    if (!m_anyMovable) return;
    const std::vector<Vec3>& x = leverPositions(body);
    for (Component& component : m_components) component.m_angularVelocity = spin(component);
    forEachNode(body.m_model->mesh().nodeComponent(), m_components,
                [&](const Component& component, int i)
                {
                    if (!component.m_isMovable || body.m_state.m_fixed[i]) return;
                    const Vec3& w = component.m_angularVelocity;
                    const Vec3 inward = cross(w, cross(w, x[i] - component.m_center));
                    b[i] -= (step * body.m_state.m_mass[i]) * inward;
                });
}

void RigidMomentum::removeMomentum(const Body& body, double step, const std::vector<Vec3>& x, std::vector<Vec3>& change)
{
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    findCenters(body, x);
    forEachNode(componentOf, m_components,
                [&](Component& component, int i)
                {
                    const Vec3 r = x[i] - component.m_center;
                    component.m_inverseInertia += body.m_state.m_mass[i] * (Mat3::diagonal(dot(r, r)) - outer(r, r));
                });
    findMovable(body, step, x);
    if (m_anyMovable) addRigid(body, x, true, change);
}

}  // namespace bullet_fem
