// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The exact part of a body's motion: components move and turn as free rigid bodies.
#include <algorithm>
#include <cmath>

#include "fem/body/rigid_momentum.h"
#include "fem/body/rigid_sums.h"
#include "fem/body/step_scratch.h"
#include "fem/common/rotation.h"

namespace bullet_fem
{
namespace
{

constexpr int kMidpointIterations = 3;  // of the implicit midpoint rule, whose error is then below its own

}  // namespace

void RigidMomentum::measure(const Body& body, double step, const std::vector<Vec3>& x, const std::vector<Vec3>& v)
{
    const BodyState& s = body.m_state;
    findCenters(body, x);
    for (Component& component : m_components)
        if (component.m_pivot >= 0) component.m_carried = body.m_loads.m_targetVelocity[component.m_pivot];
    forEachNode(body.m_model->mesh().nodeComponent(), m_components,
                [&](Component& component, int i)
                {
                    const Vec3 r = x[i] - component.m_center, p = s.m_mass[i] * (v[i] - component.m_carried);
                    component.m_linear += p;
                    component.m_angular += cross(r, p);
                    component.m_inverseInertia += inertiaOf(s.m_mass[i], r);
                });
    findMovable(body, step, x);
}

Mat3 RigidMomentum::freeRotation(const Mat3& inverseInertia, const Vec3& L, double time)
{
    const double turn = time * norm(inverseInertia * L);
    if (!(turn > 0) || !std::isfinite(turn)) return Mat3::identity();
    const int steps = static_cast<int>(std::min(std::ceil(turn / kMaxTurn), double(kMaxTurns)));
    const double part = time / steps;
    Mat3 R = Mat3::identity();
    const auto spinAt = [&](const Mat3& rotation) { return rotation * (inverseInertia * transposeTimes(rotation, L)); };
    for (int k = 0; k < steps; ++k)
    {
        Vec3 w = spinAt(R);
        for (int i = 0; i < kMidpointIterations; ++i) w = spinAt(exponential(0.5 * part * w) * R);
        R = exponential(part * w) * R;
    }
    return R;
}

// Inverse of an inertia about the centre, of what the component can turn about.
Mat3 RigidMomentum::inverted(const Component& component, const Mat3& inertia) const
{
    if (component.m_pivot < 0) return inverseInertia(inertia, component.m_mass, component.m_end);
    if (!(dot(component.m_axis, component.m_axis) > 0)) return boundedInverse(inertia, 0);
    const double aboutAxis = dot(component.m_axis, inertia * component.m_axis);
    return aboutAxis > 0 ? (1 / aboutAxis) * outer(component.m_axis, component.m_axis) : Mat3();
}

void RigidMomentum::beginAdvance(double time) const
{
    for (Component& component : m_components)
    {
        component.m_rotation = Mat3::identity();
        component.m_inertia = Mat3();
        component.m_elastic = {};
        if (!component.m_isMovable) continue;
        component.m_linearVelocity =
            component.m_pivot < 0 ? (1 / component.m_mass) * component.m_linear : component.m_carried;
        component.m_angularVelocity = component.m_inverseInertia * component.m_angular;
        component.m_rotation = freeRotation(component.m_inverseInertia, component.m_angular, time);
        component.m_end = component.m_center + time * component.m_linearVelocity;
    }
}

void RigidMomentum::endAdvance() const
{
    for (Component& component : m_components)
    {
        if (!component.m_isMovable) continue;
        const Mat3 &R = component.m_rotation, inverse = inverted(component, component.m_inertia);
        const Vec3 L = transposeTimes(R, component.m_angular) - component.m_elastic, w = inverse * L;
        // refined, as the bound of the inverse would lose 1e-14 of L in every step
        component.m_angularVelocity = R * (w + inverse * (L - component.m_inertia * w));
    }
}

void RigidMomentum::advance(const Body& body, double time, const Moving& moving, std::vector<Vec3>& xNext,
                            std::vector<Vec3>* vNext) const
{
    const BodyState& s = body.m_state;
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    beginAdvance(time);
    forEachNode(componentOf, m_components,
                [&](Component& component, int i)
                {
                    const Vec3 x = moving.m_x[i], v = moving.m_v[i], vEnd = moving.m_vEnd[i];
                    if (!component.m_isMovable)
                    {
                        xNext[i] = x + time * v;
                        if (vNext) (*vNext)[i] = vEnd;
                        return;
                    }
                    const Vec3 r = x - component.m_center;
                    const Vec3 rigid = component.m_linearVelocity + cross(component.m_angularVelocity, r);
                    const Vec3 strained = s.m_fixed[i] ? r : r + time * (v - rigid);
                    xNext[i] = component.m_end + component.m_rotation * strained;
                    const Vec3 elastic = s.m_fixed[i] ? Vec3() : vEnd - rigid;
                    component.m_inertia += inertiaOf(s.m_mass[i], strained);
                    const Vec3 turned = transposeTimes(component.m_rotation, elastic);
                    component.m_elastic += cross(strained, s.m_mass[i] * transposeTimes(component.m_rotation, turned));
                    if (vNext) (*vNext)[i] = s.m_fixed[i] ? vEnd : turned;
                });
    if (!vNext) return;
    endAdvance();
    forEachNode(componentOf, m_components,
                [&](const Component& component, int i)
                {
                    if (component.m_isMovable && !s.m_fixed[i])
                        (*vNext)[i] +=
                            component.m_linearVelocity + cross(component.m_angularVelocity, xNext[i] - component.m_end);
                });
}

void RigidMomentum::turnElastic(const Body& body, std::vector<Vec3>& vectors) const
{
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    for (std::size_t i = 0; i < vectors.size(); ++i)
        vectors[i] = transposeTimes(m_components[componentOf[i]].m_rotation, vectors[i]);
}

}  // namespace bullet_fem
