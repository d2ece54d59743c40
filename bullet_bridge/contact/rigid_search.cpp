// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid_search.h"

#include <algorithm>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/fem/common/threads.h"

namespace bullet_fem
{
namespace
{

// Null if that cannot be known.
btBroadphaseInterface* broadphaseOf(const FemSoftBody& fem)
{
    const btSoftBodyWorldInfo* world = fem.m_softBody->m_worldInfo;
    btBroadphaseInterface* broadphase = world ? world->m_broadphase : nullptr;
    return broadphase && broadphase->getOverlappingPairCache() ? broadphase : nullptr;
}

// To where the object was before Bullet moved it.
void moveBack(ShapeLeaf& leaf, const RigidProxy& rigidProxy, double step)
{
    const Vec3 present = rigidProxy.m_center + step * rigidProxy.m_linearVelocity;
    leaf = movedBack(leaf, {present, rigidProxy.m_linearVelocity, rigidProxy.m_angularVelocity}, step);
}

// True for shapes whose distances are closed forms or come of our own search over their corners. Others ask Bullet,
// which locks meshes and counts in globals, or a program's own code.
bool bearsThreads(const btCollisionShape& shape)
{
    switch (shape.getShapeType())
    {
        case BOX_SHAPE_PROXYTYPE:
        case SPHERE_SHAPE_PROXYTYPE:
        case CAPSULE_SHAPE_PROXYTYPE:
        case CYLINDER_SHAPE_PROXYTYPE:
        case CONE_SHAPE_PROXYTYPE:
        case STATIC_PLANE_PROXYTYPE:
        case CONVEX_HULL_SHAPE_PROXYTYPE:
        case MULTI_SPHERE_SHAPE_PROXYTYPE:
            return true;
        default:
            return false;
    }
}

}  // namespace

RigidSearch::RigidSearch(const Threads& threads) : m_threads(threads), m_finders(kParts) {}

void RigidSearch::find(const std::vector<FemSoftBody*>& bodies, double step, int maxContacts,
                       RigidProxies& rigidProxies)
{
    m_touching.clear();
    m_touched.clear();
    m_shapes.clear();
    m_leaves.resizeNoInitialize(0);
    listOverlapping(bodies);
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        removeGone(*bodies[b], static_cast<int>(b));
        listTouched(*bodies[b], step, rigidProxies);
    }
    m_reports.assign(bodies.size(), {});

    const auto findOf = [&](ContactFinder& finder, std::size_t b)
    {
        const Touching& touching = m_touching[b];
        m_reports[b] = finder.find(*bodies[b], static_cast<int>(b),
                                   {m_touched.data() + touching.m_first, touching.m_count, m_leaves,
                                    rigidProxies.rigidProxies(), step, maxContacts});
    };
    m_threads.run(kParts,
                  [&](int part)
                  {
                      const std::size_t end = bodies.size() * (part + 1) / kParts;
                      for (std::size_t b = bodies.size() * part / kParts; b < end; ++b)
                          if (!m_touching[b].m_alone) findOf(m_finders[part], b);
                  });
    for (std::size_t b = 0; b < bodies.size(); ++b)
        if (m_touching[b].m_alone) findOf(m_finders.front(), b);
}

// What else the bodies overlap in Bullet's broad phase. Pairs are compared by address: what left the world since it was
// recorded may be deleted.
void RigidSearch::listOverlapping(const std::vector<FemSoftBody*>& bodies)
{
    m_byAddress.clear();
    for (std::size_t b = 0; b < bodies.size(); ++b)
        m_byAddress.emplace_back(bodies[b]->m_softBody, static_cast<int>(b));
    std::sort(m_byAddress.begin(), m_byAddress.end());
    const auto indexOf = [this](const void* object)
    {
        const auto at = std::lower_bound(m_byAddress.begin(), m_byAddress.end(), std::make_pair(object, 0));
        return at != m_byAddress.end() && at->first == object ? at->second : -1;
    };
    m_overlapping.clear();
    m_broadphases.clear();
    for (const FemSoftBody* fem : bodies)
    {
        btBroadphaseInterface* broadphase = fem->m_touching.empty() ? nullptr : broadphaseOf(*fem);
        if (!broadphase || std::find(m_broadphases.begin(), m_broadphases.end(), broadphase) != m_broadphases.end())
            continue;
        m_broadphases.push_back(broadphase);
        const btBroadphasePairArray& pairs = broadphase->getOverlappingPairCache()->getOverlappingPairArray();
        for (int i = 0; i < pairs.size(); ++i)
        {
            const void *a = pairs[i].m_pProxy0->m_clientObject, *b = pairs[i].m_pProxy1->m_clientObject;
            const int first = indexOf(a), second = indexOf(b);
            if (first >= 0 && second < 0) m_overlapping.emplace_back(first, b);
            if (second >= 0 && first < 0) m_overlapping.emplace_back(second, a);
        }
    }
    std::sort(m_overlapping.begin(), m_overlapping.end());
}

void RigidSearch::removeGone(FemSoftBody& fem, int body) const
{
    if (!broadphaseOf(fem)) return;
    const auto isGone = [&](const void* object)
    { return !std::binary_search(m_overlapping.begin(), m_overlapping.end(), std::make_pair(body, object)); };
    fem.m_touching.erase(std::remove_if(fem.m_touching.begin(), fem.m_touching.end(), isGone), fem.m_touching.end());
}

void RigidSearch::listTouched(FemSoftBody& fem, double step, RigidProxies& rigidProxies)
{
    std::sort(fem.m_touching.begin(), fem.m_touching.end(),
              [](const auto* a, const auto* b) { return broadphaseId(*a) < broadphaseId(*b); });
    Touching touching = {static_cast<int>(m_touched.size()), static_cast<int>(fem.m_touching.size()), false};
    for (const btCollisionObject* object : fem.m_touching)
    {
        const int rigidProxy = rigidProxies.indexForContact(*object, step, fem.m_body);
        const ShapeRange& shape = shapeOf(*object, rigidProxy, step, rigidProxies);
        touching.m_alone = touching.m_alone || shape.m_alone;
        m_touched.push_back({object, rigidProxy, shape.m_first, shape.m_count, shape.m_unknown});
    }
    m_touching.push_back(touching);
}

// The leaves of an object's shape, collected when first asked for.
const RigidSearch::ShapeRange& RigidSearch::shapeOf(const btCollisionObject& object, int rigidProxy, double step,
                                                    const RigidProxies& rigidProxies)
{
    if (m_shapes.size() < rigidProxies.rigidProxies().size()) m_shapes.resize(rigidProxies.rigidProxies().size());
    ShapeRange& range = m_shapes[rigidProxy];
    if (range.m_first >= 0) return range;
    range.m_first = m_leaves.size();
    range.m_unknown = collectShapeLeaves(object, m_leaves) > 0;
    range.m_count = m_leaves.size() - range.m_first;
    for (int l = range.m_first; l < m_leaves.size(); ++l)
    {
        if (rigidProxies.isRewound(rigidProxy)) moveBack(m_leaves[l], rigidProxies.rigidProxies()[rigidProxy], step);
        range.m_alone = range.m_alone || !bearsThreads(*m_leaves[l].m_shape);
    }
    return range;
}

}  // namespace bullet_fem
