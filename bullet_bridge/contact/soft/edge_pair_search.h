// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/contact/soft/node_surface_search.h"
#include "bullet_bridge/geometry/surface/near_ridges.h"

namespace bullet_fem
{

/// Results of the node searches of two surfaces, as input of the edge search.
struct NodesFound
{
    const NodeSurfaceSearch& m_ofFirst;
    const NodeSurfaceSearch& m_ofSecond;
};

/// Edge indices, one of each surface.
struct EdgePair
{
    int m_first, m_second;
};

/// Finds the crossings of ridges of two surfaces, or of one surface with itself. A pair is a contact if the nearest
/// points lie in the interior of both edges, and the direction between them lies between the normals of the faces at
/// either edge (their arcs cross on the Gauss sphere), so that it separates the surfaces. Flat edges need no contacts
/// of their own: nodes at the border of flat regions, and crossings of rims, carry their load. Edges that pushed each
/// other remain a pair, however flat, until one is a groove. Pairs beyond the contact band are tested by continuous
/// collision detection. Scratch grows, never shrinks.
class EdgePairSearch
{
public:
    /// Appends contacts, ascending by edge of `first`, then of `second`; equal surfaces mean self contact. `held`:
    /// pairs that pushed in the last step.
    void find(const SoftSurface& first, const SoftSurface& second, const ContactReach& reach, const NodesFound& nodes,
              const std::vector<EdgePair>& held, std::vector<SurfaceContact>& touches);

private:
    struct Pair
    {
        int m_edgeA, m_edgeB;
        std::array<int, 4> m_nodes;  // two of A, two of B
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
    ContactReach m_reach;
    RidgeReach m_ridgeReach;
    NearRidges m_ridgesA, m_ridgesB;
    std::vector<SurfaceContact>* m_touches = nullptr;
};

}  // namespace bullet_fem
