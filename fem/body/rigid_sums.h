// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Inverse of an inertia tensor, bounded along axes without inertia (a component collapsed to a point or a line). Zero
/// if the trace is at most `rounding` [kg m2].
inline Mat3 boundedInverse(const Mat3& inertia, double rounding)
{
    const double size = trace(inertia);
    if (!(size > rounding)) return {};
    return inverse(inertia + Mat3::diagonal(1e-14 * size));
}

/// Share of a component's radius of gyration [-]: fixed nodes whose lever about an axis is shorter have no moment about
/// it, and do not turn the component about it.
constexpr double kShortestLever = 1e-3;

/// The spin of masses with this inertia that has the angular momentum L, but for axes about which they have less than
/// `least` [kg m2].
Vec3 spinOf(const Mat3& inertia, const Vec3& L, double least);

/// Calls add(component, i) for every node, in order. Consecutive nodes mostly belong to one component, whose sums then
/// stay in registers instead of waiting for memory.
template <class Component, class Add>
void forEachNode(const std::vector<int>& componentOf, std::vector<Component>& components, const Add& add)
{
    const int n = static_cast<int>(componentOf.size());
    for (int i = 0; i < n;)
    {
        const int c = componentOf[i];
        Component component = components[c];
        for (; i < n && componentOf[i] == c; ++i) add(component, i);
        components[c] = component;
    }
}

/// m (|r|^2 - r r^T), a node's inertia.
inline Mat3 inertiaOf(double mass, const Vec3& r)
{
    return mass * (Mat3::diagonal(dot(r, r)) - outer(r, r));
}

}  // namespace bullet_fem
