// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/body/led_motion.h"

#include <cmath>
#include <cstring>

#include "fem/body/rigid_sums.h"

namespace bullet_fem
{

// The rotation vector phi a, |a| = 1 [rad]. A rotation changes r by 2 tan(phi / 2) a x m, with m the mean of r before
// and after; the sums give the 2 tan(phi / 2) a of least squares.
Vec3 LedMotion::turnOf(const Component& component)
{
    const double share = 1.0 / component.m_count, perNode = 1.0 / component.m_nodes;
    const Vec3 moment = component.m_moment - share * cross(component.m_halfway, component.m_moved);
    if (!(dot(moment, moment) > 0)) return {};
    const Vec3 middle = perNode * component.m_position;
    const double spread = perNode * component.m_square - dot(middle, middle);
    const Mat3 inertia = component.m_inertia - inertiaOf(share, component.m_halfway);
    const Vec3 tangent = spinOf(inertia, moment, kShortestLever * kShortestLever * component.m_count * spread);
    const double length = norm(tangent);
    return length > 0 ? (2 * std::atan(0.5 * length) / length) * tangent : Vec3();
}

void LedMotion::find(const TetMesh& mesh, const BodyState& state, const StepLoads& loads, double step)
{
    const std::vector<Vec3>&x = state.m_x, &target = loads.m_targetVelocity;
    m_turns = m_changes = false;
    if (!std::memchr(state.m_fixed.data(), 1, state.m_fixed.size())) return;
    for (Component& component : m_components) component = Component();
    forEachNode(mesh.nodeComponent(), m_components,
                [&](Component& component, int i)
                {
                    ++component.m_nodes;
                    component.m_position += x[i] - x[0];
                    component.m_square += dot(x[i] - x[0], x[i] - x[0]);
                    if (!state.m_fixed[i]) return;
                    if (component.m_first < 0) component.m_first = i;
                    const Vec3 moved = step * (target[i] - target[component.m_first]);
                    const Vec3 halfway = x[i] - x[component.m_first] + 0.5 * moved;
                    ++component.m_count;
                    component.m_halfway += halfway;
                    component.m_moved += moved;
                    component.m_moment += cross(halfway, moved);
                    component.m_inertia += inertiaOf(1, halfway);
                });
    for (Component& component : m_components)
    {
        if (component.m_count == 0) continue;
        component.m_change = target[component.m_first] - state.m_v[component.m_first];
        m_changes = m_changes || dot(component.m_change, component.m_change) > 0;
        const Vec3 turn = turnOf(component);
        if (!(dot(turn, turn) > 0)) continue;
        component.m_spin = (1 / step) * turn;
        component.m_center = x[component.m_first];
        component.m_velocity = target[component.m_first];
        m_turns = true;
    }
}

void LedMotion::removeChange(const std::vector<int>& componentOf, std::vector<Vec3>& change) const
{
    for (std::size_t i = 0; i < change.size() && m_changes; ++i) change[i] -= m_components[componentOf[i]].m_change;
}

}  // namespace bullet_fem
