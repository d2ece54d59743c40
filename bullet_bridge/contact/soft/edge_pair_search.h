// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/contact/soft/node_surface_search.h"
#include "bullet_bridge/geometry/surface/near_ridges.h"

namespace bullet_fem
{

/// What the nodes of two surfaces have found, for the edges to agree with.
struct NodesFound
{
    const NodeSurfaceSearch& m_ofFirst;
    const NodeSurfaceSearch& m_ofSecond;
};

/// An edge of either surface.
struct EdgePair
{
    int m_first, m_second;
};

/// Finds where ridges of two surfaces, or of one with itself, cross each other. A pair touches if the nearest points
/// lie between the ends of both edges, and the direction between them separates the surfaces: it lies between the
/// normals of the faces at either edge (their arcs cross on the sphere of directions). Edges that are not bent need no
/// contacts of their own: the nodes at the ends of flat regions, and crossings of rims, carry all that these can; but
/// edges that pushed each other remain a pair until one is a groove, however flat they have become. What comes from
/// farther than the band is tested at the time when the edges meet. Scratch grows, never shrinks.
class EdgePairSearch
{
public:
    /// Appends touches by ascending edges of `first`, then of `second` (the same: self contact). `held`: those that
    /// pushed each other in the last step.
    void find(const SoftSurface& first, const SoftSurface& second, const TouchReach& reach, const NodesFound& nodes,
              const std::vector<EdgePair>& held, std::vector<SurfaceTouch>& touches);

private:
    struct Pair
    {
        int m_edgeA, m_edgeB;
        std::array<int, 4> m_nodes;  // of A, of B
        std::array<Vec3, 4> m_x, m_change;
    };
    struct Crossing
    {
        LineParameters m_at;
        Vec3 m_normal;
        double m_gap;
    };

    Pair pairOf(const SurfaceRidges::Ridge& a, const SurfaceRidges::Ridge& b) const;
    void tryHeld(const EdgePair& held, const NodesFound& nodes);
    bool areClose(const Pair& pair) const;
    void listNear();
    bool mayTouch(const CoarseBox& a, const CoarseBox& b) const;
    void tryRuns(const NearRidges::Run& runA, const NearRidges::Run& runB, const NodesFound& nodes);
    void tryPair(const NearRidges::Item& a, const NearRidges::Item& b, bool mayCross, bool mayMeet,
                 const NodesFound& nodes);
    bool tryNear(const Pair& pair, const NodesFound& nodes, Crossing& crossing) const;
    bool isFreeWayOut(const Pair& pair, const Crossing& crossing) const;
    static bool stayApart(const Pair& pair, const Vec3& direction);
    static bool cannotMeet(const Pair& pair, const Vec3& travel);
    bool tryImpact(const Pair& pair, Crossing& crossing) const;
    bool separates(const Pair& pair, const Vec3& normal, double tolerance) const;
    void emit(const Pair& pair, const Crossing& crossing);

    const SoftSurface *m_first = nullptr, *m_second = nullptr;
    TouchReach m_reach;
    RidgeReach m_ridgeReach;
    NearRidges m_ridgesA, m_ridgesB;
    std::vector<SurfaceTouch>* m_touches = nullptr;
};

}  // namespace bullet_fem
