// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/surface/surface_contact.h"

namespace bullet_fem
{

/// Finds the contacts of a surface's nodes with the faces of another surface or of its own. The nearest point of the
/// closed surface tells whether a node is inside. Then the contacts are:
///   - outside: the faces in front of the node; several in a groove or corner, one of those that continue each other;
///   - inside: the nearest face that opposes the node's normal, and the next face where that one ends in a groove;
///   - over no face: the nearest edge or corner, if the direction to it separates the two surfaces there;
///   - beyond the contact band: the face that the node meets first on its straight path.
/// Faces extend a thousandth of an edge beyond their rims, so that surfaces with flush rims support each other. Self
/// contact skips pairs that are neighbours at rest. Scratch grows, never shrinks.
class NodeSurfaceSearch
{
public:
    /// Appends the contacts of `nodes`' nodes with `faces`, ascending by node and triangle; equal surfaces mean self
    /// contact. The feature of a nearest edge or corner is -1. `done`, if not null, is the finished search with
    /// exchanged surfaces: pairs of nodes that it found are left out.
    void find(const SoftSurface& nodes, const SoftSurface& faces, const ContactReach& reach,
              const NodeSurfaceSearch* done, std::vector<SurfaceContact>& touches);

    /// Depth of a node that was found inside, if its way out differs from `direction` (unit) [m]; infinity otherwise.
    double depthAside(int node, const Vec3& direction) const;

private:
    enum class Place
    {
        over,    // over the face
        groove,  // beyond an edge, where the next face rises
        rim      // beyond an edge, where the next face falls away
    };
    struct Hit
    {
        int m_triangle;
        std::array<double, 3> m_weights;
        Vec3 m_normal;
        double m_gap;
        double m_time;  // of the impact, in steps; 0: the gap is that at the start
        Place m_place;
        bool m_dropped;
    };
    struct Visit  // state of one node's search
    {
        int m_node = 0;
        Vec3 m_x, m_change, m_normal;
        int m_nearestTriangle = -1;
        TrianglePoint m_nearest;
        double m_distance = 0;
        bool m_inside = false;
        double m_limit = 0;  // largest credible depth [m]
    };

    void forget();
    void listNear();
    void findNode(int node);
    bool isClose(int node, int triangle) const;
    bool lookAround(Visit& visit);
    void tryFace(const Visit& visit, int triangle);
    void tryDeepFace(const Visit& visit);
    bool isFacing(const Visit& visit, int triangle) const;
    bool placeOf(int triangle, const std::array<double, 3>& weights, Place& place) const;
    bool isNear(const Visit& visit, const Hit& hit) const;
    bool staysAside(const Visit& visit, const Hit& hit) const;
    void tryImpact(const Visit& visit, int triangle);
    void choose(const Visit& visit);
    void dropRims(const Visit& visit);
    void dropContinuations();
    void tryNearestFeature(const Visit& visit);
    void emit(const Visit& visit, const Hit& hit);
    bool isPairedAlready(int node, int corner) const;

    const SoftSurface *m_nodes = nullptr, *m_faces = nullptr;
    const NodeSurfaceSearch* m_done = nullptr;
    ContactReach m_reach;
    int m_guess = -1;  // triangle nearest to the last node: consecutive nodes are often neighbours
    std::vector<SurfaceContact>* m_touches = nullptr;
    std::vector<Hit> m_hits;
    std::vector<int> m_near;      // tested nodes, ascending
    std::vector<double> m_depth;  // per node [m]; infinity for nodes that are not inside
    std::vector<Vec3> m_wayOut;   // per node, unit; valid with a finite depth
    std::vector<int> m_partner;   // per node, the corner that it lies on; -1: none
};

}  // namespace bullet_fem
