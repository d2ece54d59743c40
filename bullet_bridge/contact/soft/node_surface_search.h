// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/surface/outside_proof.h"
#include "bullet_bridge/geometry/surface/surface_touch.h"

namespace bullet_fem
{

/// Finds where the nodes of a surface touch the faces of another, or of itself. The nearest point of the whole closed
/// surface says whether a node is inside; then every face that it lies over is a contact:
///  - outside, the faces in front of it: several of them in a groove or corner, one of those that continue each other;
///  - inside, the nearest face that its own surface is turned to, and where this ends in a groove, the next one;
///  - if it lies over no face, the nearest edge or corner, if their connection separates the two surfaces there;
///  - what comes from farther than the band hits the face that it first meets on its straight way.
/// Faces reach a thousandth of an edge beyond their rims, so that surfaces with flush rims hold each other. A body is
/// never asked against neighbours at rest of itself. Scratch grows, never shrinks.
class NodeSurfaceSearch
{
public:
    /// Appends the touches of `nodes`' nodes with `faces` (the same: self contact), by ascending node and triangle; the
    /// feature of a nearest edge or corner is -1. `done`, if given, are the results for the two exchanged: pairs of
    /// nodes that they have are left out.
    void find(const SoftSurface& nodes, const SoftSurface& faces, const TouchReach& reach,
              const NodeSurfaceSearch* done, std::vector<SurfaceTouch>& touches);

    /// How deep a node was found inside, where it has another way out than along a direction (unit) [m]; infinite if it
    /// was not, or has not.
    double depthAside(int node, const Vec3& direction) const;

private:
    enum class Place
    {
        over,    // the face
        groove,  // beyond its edge, where the next face rises
        rim      // beyond its edge, where the next face falls away
    };
    struct Hit
    {
        int m_triangle;
        std::array<double, 3> m_weights;
        Vec3 m_normal;
        double m_gap;
        double m_time;  // of the impact, in steps; 0: measured at the start
        Place m_place;
        bool m_dropped;
    };
    struct Visit  // of one node
    {
        int m_node = 0;
        Vec3 m_x, m_change, m_normal;
        int m_nearestTriangle = -1;
        TrianglePoint m_nearest;
        double m_distance = 0;
        bool m_inside = false;
        double m_limit = 0;  // depth that is believed
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
    void dropDeeper();
    void dropLaterImpacts();
    void dropContinuations();
    void tryNearestFeature(const Visit& visit);
    void emit(const Visit& visit, const Hit& hit);
    bool isPairedAlready(int node, int corner) const;

    const SoftSurface *m_nodes = nullptr, *m_faces = nullptr;
    const NodeSurfaceSearch* m_done = nullptr;
    TouchReach m_reach;
    OutsideProof m_outside;  // of the faces, once it is worth it
    int m_looks = 0;
    int m_guess = -1;  // what was nearest to the node before: numbers that follow each other are often neighbours
    std::vector<SurfaceTouch>* m_touches = nullptr;
    std::vector<Hit> m_hits;
    std::vector<int> m_near;      // nodes that were asked, ascending
    std::vector<double> m_depth;  // infinite for all others
    std::vector<Vec3> m_wayOut;   // unit; of those with a depth
    std::vector<int> m_partner;   // the corner that a node lies on; -1: none, and for all others
};

}  // namespace bullet_fem
