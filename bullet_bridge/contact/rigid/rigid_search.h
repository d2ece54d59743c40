// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>

#include "bullet_bridge/contact/rigid/contact_finder.h"

class btBroadphaseInterface;

namespace bullet_fem
{

class Threads;

/// Finds the contacts of FEM bodies with the rigid objects that the broad phase recorded, on the given threads. The
/// same contacts in the same order for any number of them. Grows, never shrinks.
class RigidSearch
{
public:
    /// `threads` must live as long as the search.
    explicit RigidSearch(const Threads& threads);
    RigidSearch(const RigidSearch&) = delete;
    RigidSearch& operator=(const RigidSearch&) = delete;

    /// Bodies in an order that does not depend on addresses, after solveFreeMotion: m_contacts and m_origins of each
    /// become those of this step, with m_soft.m_body = its place. At most maxContacts a body are kept; `step` [s].
    void find(const std::vector<FemSoftBody*>& bodies, double step, int maxContacts, RigidProxies& rigidProxies);

    /// What find() found besides contacts, one a body.
    const std::vector<ContactSearchReport>& reports() const { return m_reports; }

private:
    static constexpr int kParts = 32;  // of the bodies, whatever the number of threads

    /// What bodies touch is looked up on one thread: rigid proxies are made when first asked for.
    struct Touching
    {
        int m_first, m_count;  // among m_touched
        bool m_alone;          // Bullet's shapes are asked that may not bear several threads
    };
    struct ShapeRange
    {
        int m_first = -1, m_count = 0;  // among m_leaves
        bool m_unknown = false, m_alone = false;
    };

    void listCarrying(const std::vector<FemSoftBody*>& bodies);
    CarryingPlane carryingPlaneOf(const btCollisionObject& object, const RigidProxy& rigidProxy, double step) const;
    void listOverlapping(const std::vector<FemSoftBody*>& bodies);
    void removeGone(FemSoftBody& fem, int body) const;
    void listTouched(FemSoftBody& fem, double step, RigidProxies& rigidProxies);
    const ShapeRange& shapeOf(const btCollisionObject& object, int rigidProxy, double step,
                              const RigidProxies& rigidProxies);

    /// What the soft bodies gave an object in the last step.
    struct Carried
    {
        int m_objectId;
        double m_sum;      // of the sizes of the normal impulses [N s]
        double m_largest;  // of these [N s], and its normal:
        int m_count;       // contacts that have this one, too
        double m_onFace;   // the sum of their sizes [N s]
        Vec3 m_normal;     // unit, from the object to the soft bodies
        Vec3 m_foot;       // of their points on the object, times the sizes [N s m]
    };

    bool givesTriangles(const ShapeLeaf& leaf);

    const Threads& m_threads;
    std::vector<ContactFinder> m_finders;
    std::vector<Touching> m_touching;      // one a body
    std::vector<TouchedObject> m_touched;  // body by body
    std::vector<ShapeRange> m_shapes;      // one a rigid proxy
    btAlignedObjectArray<ShapeLeaf> m_leaves;
    std::vector<const btCollisionShape*> m_giving;  // of a program's own shapes those that gave triangles, ascending
    std::vector<Carried> m_carried;                 // by object, ascending
    std::vector<ContactSearchReport> m_reports;
    std::vector<std::pair<const void*, int>> m_byAddress;     // bodies, ascending
    std::vector<const btBroadphaseInterface*> m_broadphases;  // of theirs, each once
    std::vector<std::pair<int, const void*>> m_overlapping;   // bodies and what they overlap there, ascending
};

}  // namespace bullet_fem
