// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <limits>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Limits the paths of surface vertices by the planes of their contacts at the beginning of the step (carriers). A
/// sliding vertex does not move into its carrier: its unconstrained path would hit side walls below the carrier's
/// surface that it never reaches.
class CarriedMotion
{
public:
    static constexpr int kNoSurface = std::numeric_limits<int>::min();

    /// Half space that a vertex must stay in.
    struct Carrier
    {
        Vec3 m_normal;      ///< unit
        double m_gap = 0;   ///< as the step begins [m]
        Vec3 m_way;         ///< displacement of the carrier within the step [m]
        int m_surface = 0;  ///< identifies the surface that the plane belongs to
        int m_next = -1;    ///< next carrier of the vertex; -1: none
    };

    /// Forgets all carriers. `lift`: distance by which liftOf() takes vertices off their carriers [m].
    void begin(int vertexCount, double lift);

    void reserve(std::size_t carriers) { m_carriers.reserve(carriers); }

    void add(int vertex, const Carrier& carrier);

    bool isCarried(int vertex) const { return m_first[vertex] >= 0; }

    /// Calls use(const Carrier&) for each carrier of the vertex.
    template <class Use>
    void forEach(int vertex, const Use& use) const
    {
        for (int k = m_first[vertex]; k >= 0; k = m_carriers[k].m_next) use(m_carriers[k]);
    }

    /// Projects a path [m] onto the half spaces of the vertex's carriers, without those of `exceptSurface`.
    Vec3 allowed(int vertex, const Vec3& way, int exceptSurface = kNoSurface) const;

    /// Displacement that takes a vertex begin()'s `lift` away from all of its carriers [m].
    Vec3 liftOf(int vertex) const;

    double lift() const { return m_lift; }

private:
    double m_lift = 0;
    std::vector<int> m_first;  // first carrier per vertex; -1: none
    std::vector<Carrier> m_carriers;
};

}  // namespace bullet_fem
