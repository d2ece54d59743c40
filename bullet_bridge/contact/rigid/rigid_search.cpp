// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/rigid_search.h"

#include <algorithm>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "BulletCollision/CollisionShapes/btTriangleCallback.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/contact_patch.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"
#include "bullet_bridge/geometry/shapes/rolling_curvature.h"
#include "bullet_bridge/geometry/shapes/triangle_soup.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "bullet_fem/fem/common/threads.h"

namespace bullet_fem
{
namespace
{

constexpr double kOneFaceCosine = 0.9999;  // smallest cosine of the normals of contacts with one flat face

// Moves a leaf back to the start of the step; `present` is the present centre of the object.
void moveBack(ShapeLeaf& leaf, const RigidProxy& rigidProxy, const Vec3& present, double step)
{
    leaf = movedBack(leaf, {present, rigidProxy.m_linearVelocity, rigidProxy.m_angularVelocity}, step);
}

void moveOn(ShapeLeaf& leaf, const Vec3& way)
{
    leaf.m_pose.m_origin += way;
    leaf.m_boundsMin += way;
    leaf.m_boundsMax += way;
}

// True if distances to a shape may be computed on several threads: closed forms, and this library's own search over
// corners. Other shapes call Bullet, which locks meshes and has global counters, or a program's own code.
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

// True for a concave shape of a program's own class.
bool isOwnSheet(const btCollisionShape& shape)
{
    return shape.getShapeType() == CUSTOM_CONCAVE_SHAPE_TYPE && isSheet(shape);
}

}  // namespace

RigidSearch::RigidSearch(const Threads& threads, bool searchesAhead)
    : m_threads(threads), m_searchesAhead(searchesAhead), m_finders(kParts), m_carrying(kOneFaceCosine)
{
}

void RigidSearch::beginStep()
{
    std::swap(m_gaveLast, m_giving);
    m_giving.clear();
}

void RigidSearch::find(const std::vector<FemSoftBody*>& bodies, double step, int maxContacts,
                       RigidProxies& rigidProxies)
{
    m_overlapping.clear();
    m_touched.clear();
    m_shapes.clear();
    m_leaves.resizeNoInitialize(0);
    listOverlapping(bodies);
    listCarrying(bodies);
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        removeGone(*bodies[b], static_cast<int>(b));
        listContacts(*bodies[b], step, rigidProxies);
    }
    m_reports.assign(bodies.size(), {});

    const auto findOf = [&](ContactFinder& finder, std::size_t b)
    {
        const Overlap& touching = m_overlapping[b];
        FemSoftBody& fem = *bodies[b];
        if (touching.m_count > 0) fem.m_search.m_meanMotion = meanMotion(fem.m_body);
        m_reports[b] = finder.find(*bodies[b], static_cast<int>(b),
                                   {m_touched.data() + touching.m_first, touching.m_count, m_leaves,
                                    rigidProxies.rigidProxies(), step, maxContacts});
    };
    m_threads.run(kParts,
                  [&](int part)
                  {
                      const std::size_t end = bodies.size() * (part + 1) / kParts;
                      for (std::size_t b = bodies.size() * part / kParts; b < end; ++b)
                          if (!m_overlapping[b].m_alone) findOf(m_finders[part], b);
                  });
    for (std::size_t b = 0; b < bodies.size(); ++b)
        if (m_overlapping[b].m_alone) findOf(m_finders.front(), b);
}

// Lists the bodies' overlaps in Bullet's broad phase with other objects. Pairs are compared by address: objects that
// have left the world since they were recorded may be deleted.
void RigidSearch::listOverlapping(const std::vector<FemSoftBody*>& bodies)
{
    m_byAddress.assign(bodies.size(), [&](std::size_t b) { return bodies[b]->m_softBody; });
    m_overlappingPairs.clear();
    m_inPairs.clear();
    m_broadphases.clear();
    for (const FemSoftBody* fem : bodies)
    {
        btBroadphaseInterface* broadphase = fem->m_overlaps.m_rigid.empty() ? nullptr : broadphaseOf(*fem);
        if (!broadphase || std::find(m_broadphases.begin(), m_broadphases.end(), broadphase) != m_broadphases.end())
            continue;
        m_broadphases.push_back(broadphase);
        const btBroadphasePairArray& pairs = broadphase->getOverlappingPairCache()->getOverlappingPairArray();
        for (int i = 0; i < pairs.size(); ++i)
        {
            const void *a = pairs[i].m_pProxy0->m_clientObject, *b = pairs[i].m_pProxy1->m_clientObject;
            const int first = m_byAddress.find(a), second = m_byAddress.find(b);
            if (first >= 0 && second < 0) m_overlappingPairs.emplace_back(first, b);
            if (second >= 0 && first < 0) m_overlappingPairs.emplace_back(second, a);
            if (first < 0) m_inPairs.push_back(a);
            if (second < 0) m_inPairs.push_back(b);
        }
    }
    std::sort(m_overlappingPairs.begin(), m_overlappingPairs.end());
    std::sort(m_inPairs.begin(), m_inPairs.end());
}

// True if an object that overlaps a FEM body can move, and is on joints or overlaps another object, too.
bool RigidSearch::mayBeStopped(const btCollisionObject& object, int rigidProxy, const RigidProxies& rigidProxies) const
{
    if (!rigidProxies.rigidProxies()[rigidProxy].canMove()) return false;
    const btRigidBody* rigid = btRigidBody::upcast(&object);
    if (rigid == nullptr || rigidProxies.isConstrained(*rigid)) return true;
    const auto pairs = std::equal_range(m_inPairs.begin(), m_inPairs.end(), static_cast<const void*>(&object));
    return pairs.second - pairs.first > 1;
}

// Finds the faces by which soft bodies carried objects in the last step.
void RigidSearch::listCarrying(const std::vector<FemSoftBody*>& bodies)
{
    m_carrying.clear();
    for (const FemSoftBody* fem : bodies)
        for (std::size_t k = 0; k < fem->m_memory.m_contacts.size(); ++k)
        {
            const ContactPoint& contact = fem->m_memory.m_contacts[k];
            const double size = dot(contact.m_impulse, contact.m_normal);
            if (size > 0)
                m_carrying.add({fem->m_memory.m_origins[k].m_objectId, size, contact.m_normal,
                                contact.m_point - contact.m_gap * contact.m_normal});
        }
    m_carrying.find();
}

// The way that a round object makes in a step along the soft surfaces that carried it in the last one.
Vec3 RigidSearch::advanceOf(const btCollisionObject& object, const ShapeLeaf& leaf, const RigidProxy& proxy,
                            double step) const
{
    const CarryingSide side =
        object.isStaticOrKinematicObject() ? CarryingSide() : m_carrying.sideOf(broadphaseId(object));
    if (!side.m_exists) return {};
    const double curvature = rollingCurvature(leaf, side.m_normal, proxy.m_angularVelocity);
    if (!(curvature > 0)) return {};
    // Without the forces of the step, which contacts bear: a ball at rest in a dimple goes nowhere.
    const btRigidBody* body = movableBody(object);
    const Vec3 velocity = body ? vec3(body->getLinearVelocity()) : proxy.m_linearVelocity;
    const Vec3 way = step * (velocity - side.m_velocity);
    const Vec3 along = way - dot(way, side.m_normal) * side.m_normal;
    return curvature * norm(along) < 1 ? along : Vec3();
}

// The plane by which a moving object lay on soft bodies in the last step, moved on to the start of this one.
CarryingPlane RigidSearch::carryingPlaneOf(const btCollisionObject& object, const RigidProxy& rigidProxy,
                                           double step) const
{
    if (norm(rigidProxy.m_linearVelocity) == 0) return {};
    RigidMotion motion = {rigidProxy.m_center, rigidProxy.m_linearVelocity, rigidProxy.m_angularVelocity};
    if (object.isKinematicObject()) motion.m_center -= step * motion.m_linearVelocity;
    return m_carrying.planeOf(broadphaseId(object), motion, step);
}

void RigidSearch::removeGone(FemSoftBody& fem, int body) const
{
    if (!broadphaseOf(fem)) return;
    const auto isGone = [&](const void* object)
    { return !std::binary_search(m_overlappingPairs.begin(), m_overlappingPairs.end(), std::make_pair(body, object)); };
    fem.m_overlaps.m_rigid.erase(std::remove_if(fem.m_overlaps.m_rigid.begin(), fem.m_overlaps.m_rigid.end(), isGone),
                                 fem.m_overlaps.m_rigid.end());
}

void RigidSearch::listContacts(FemSoftBody& fem, double step, RigidProxies& rigidProxies)
{
    std::sort(fem.m_overlaps.m_rigid.begin(), fem.m_overlaps.m_rigid.end(),
              [](const auto* a, const auto* b) { return broadphaseId(*a) < broadphaseId(*b); });
    Overlap touching = {static_cast<int>(m_touched.size()), static_cast<int>(fem.m_overlaps.m_rigid.size()), false};
    for (const btCollisionObject* object : fem.m_overlaps.m_rigid)
    {
        const int rigidProxy = rigidProxies.indexForContact(*object, step, fem.m_body);
        const ShapeRange& shape = shapeOf(*object, rigidProxy, step, rigidProxies);
        touching.m_alone = touching.m_alone || shape.m_alone;
        const RigidProxy& proxy = rigidProxies.rigidProxies()[rigidProxy];
        m_touched.push_back({object, rigidProxy, shape.m_first, shape.m_count, shape.m_unknown,
                             carryingPlaneOf(*object, proxy, step), shape.m_advance,
                             mayBeStopped(*object, rigidProxy, rigidProxies)});
    }
    m_overlapping.push_back(touching);
}

// True if a program's own concave shape reports triangles: it need not, as Bullet's height fields do not. A shape that
// reported some in this step or the last is not asked again.
bool RigidSearch::givesTriangles(const ShapeLeaf& leaf)
{
    struct Any : btTriangleCallback
    {
        bool m_any = false;
        void processTriangle(btVector3*, int, int) override { m_any = true; }
    } any;
    if (m_giving.find(leaf.m_shape) >= 0) return true;
    if (m_gaveLast.find(leaf.m_shape) < 0)
    {
        btVector3 low, high;
        leaf.m_shape->getAabb(btTransform::getIdentity(), low, high);
        forEachTriangle(*leaf.m_shape, low, high, any);
        if (!any.m_any) return false;
    }
    m_giving.add(leaf.m_shape, 0);
    return true;
}

// The leaves of an object's shape, collected at the first call in a step.
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
        range.m_unknown = range.m_unknown || (isOwnSheet(*m_leaves[l].m_shape) && !givesTriangles(m_leaves[l]));
    const RigidProxy& proxy = rigidProxies.rigidProxies()[rigidProxy];
    for (int l = range.m_first; l < m_leaves.size(); ++l)
    {
        if (rigidProxies.isRewound(rigidProxy))
            moveBack(m_leaves[l], proxy, proxy.m_center + step * proxy.m_linearVelocity, step);
        else if (object.isKinematicObject())
            moveBack(m_leaves[l], proxy, proxy.m_center, step);
        range.m_alone = range.m_alone || !bearsThreads(*m_leaves[l].m_shape);
    }
    if (m_searchesAhead && range.m_count == 1)
    {
        range.m_advance = advanceOf(object, m_leaves[range.m_first], proxy, step);
        moveOn(m_leaves[range.m_first], range.m_advance);
    }
    return range;
}

}  // namespace bullet_fem
