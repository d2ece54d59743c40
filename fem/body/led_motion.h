// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body_state.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// The rigid motion in which the fixed nodes of a component lead it in a step, V + W x (x - c), nearest to their
/// targets. All its nodes move along chords; those of a turn are no strain (docs/theory.md, Chords).
class LedMotion
{
public:
    explicit LedMotion(const TetMesh& mesh) : m_components(mesh.componentCount()) {}

    /// Finds the motions from the state at the begin of a step [s] and the target velocities.
    void find(const TetMesh& mesh, const BodyState& state, const StepLoads& loads, double step);

    /// False: W is zero in every component.
    bool turns() const { return m_turns; }

    /// V + W x (x - c) [m/s]; 0 in components that do not turn.
    Vec3 velocityAt(int component, const Vec3& x) const
    {
        const Component& led = m_components[component];
        return led.m_velocity + cross(led.m_spin, x - led.m_center);
    }

    /// W x (W x (x - c)) [m/s2].
    Vec3 inwardAt(int component, const Vec3& x) const
    {
        const Component& led = m_components[component];
        return cross(led.m_spin, cross(led.m_spin, x - led.m_center));
    }

    /// Removes the change of V since the last step from the nodes' changes of velocities [m/s], also where W = 0.
    void removeChange(const std::vector<int>& componentOf, std::vector<Vec3>& change) const;

private:
    struct Component
    {
        int m_nodes = 0;
        Vec3 m_position;          // sum over these, from the body's first node [m]
        double m_square = 0;      // sum of its square [m2]
        int m_first = -1;         // the first fixed node, whose position is c
        int m_count = 0;          // of fixed nodes
        Vec3 m_halfway, m_moved;  // sums over these of r = x - c halfway through the step, and of its change [m]
        Vec3 m_moment;            // sum of r x its change [m2]
        Mat3 m_inertia;           // of unit masses at r [m2]
        Vec3 m_center;            // [m]
        Vec3 m_velocity, m_spin;  // V [m/s], W [rad/s]
        Vec3 m_change;            // of V [m/s]
    };
    static Vec3 turnOf(const Component& component);

    std::vector<Component> m_components;
    bool m_turns = false, m_changes = false;
};

}  // namespace bullet_fem
