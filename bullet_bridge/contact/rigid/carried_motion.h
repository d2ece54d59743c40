// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <limits>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// How far the vertices of a surface can go within a step past what they touch as it begins. What slides over a surface
/// does not fly through it: the way that it would take if nothing carried it meets side walls, of what lies flush in
/// the surface, that it will never come to.
class CarriedMotion
{
public:
    static constexpr int kNoSurface = std::numeric_limits<int>::min();

    /// Half of space that a vertex must stay in.
    struct Carrier
    {
        Vec3 m_normal;      ///< unit
        double m_gap = 0;   ///< as the step begins [m]
        Vec3 m_way;         ///< of the carrier within the step [m]
        int m_surface = 0;  ///< a number for what it is part of
        int m_next = -1;    ///< of the same vertex; -1: none
    };

    /// Forgets all. Vertices are lifted off their carriers by `lift` [m].
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

    /// A way [m] without what leads into carriers, but for those of one surface.
    Vec3 allowed(int vertex, const Vec3& way, int exceptSurface = kNoSurface) const;

    /// Takes a vertex as far off all of its carriers as begin() says [m].
    Vec3 liftOf(int vertex) const;

    double lift() const { return m_lift; }

private:
    double m_lift = 0;
    std::vector<int> m_first;  // of every vertex; -1: none
    std::vector<Carrier> m_carriers;
};

}  // namespace bullet_fem
