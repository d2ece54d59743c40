// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/shape_mark.h"

#include <cmath>
#include <limits>

#include "BulletCollision/BroadphaseCollision/btDbvt.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "BulletCollision/CollisionShapes/btConvexHullShape.h"
#include "BulletCollision/CollisionShapes/btSdfCollisionShape.h"
#include "BulletCollision/CollisionShapes/btTriangleCallback.h"
#include "BulletCollision/Gimpact/btGImpactShape.h"
#include "LinearMath/btAabbUtil2.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"
#include "bullet_bridge/geometry/shapes/shape_distance.h"
#include "bullet_bridge/geometry/shapes/triangle_soup.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "fem/common/byte_stream.h"

namespace bullet_fem
{
namespace
{

struct MarkedBox
{
    btVector3 m_low, m_high;
};

// True for finite boxes with ordered corners: Bullet's trees accept no others.
bool isBox(const MarkedBox& box)
{
    for (int c = 0; c < 3; ++c)
        if (!(box.m_low[c] <= box.m_high[c]) || !std::isfinite(box.m_low[c]) || !std::isfinite(box.m_high[c]))
            return false;
    return true;
}

MarkedBox inFrame(const MarkedBox& box, const btTransform& frame)
{
    MarkedBox local = box;
    if (isBox(box)) btTransformAabb(box.m_low, box.m_high, 0, frame.inverse(), local.m_low, local.m_high);
    return local;
}

void addVector(std::uint64_t& mark, const btVector3& v)
{
    for (int c = 0; c < 3; ++c) addToMark(mark, v[c]);
}

void addPlacement(std::uint64_t& mark, const btTransform& transform)
{
    for (int row = 0; row < 3; ++row) addVector(mark, transform.getBasis()[row]);
    addVector(mark, transform.getOrigin());
}

// Sums the hashes of triangles, so that their order does not matter.
class TriangleMarks : public btTriangleCallback
{
public:
    void processTriangle(btVector3* corners, int, int) override
    {
        std::uint64_t mark = kEmptyMark;
        for (int a = 0; a < 3; ++a) addVector(mark, corners[a]);
        m_sum += mark;
    }

    std::uint64_t m_sum = 0;
};

std::uint64_t markOfSheet(const btCollisionShape& sheet, const MarkedBox& box)
{
    TriangleMarks marks;
    const btScalar margin = sheet.getMargin();
    const btVector3 around(margin, margin, margin);
    const MarkedBox reached = {box.m_low - around, box.m_high + around};
    if (isBox(reached)) forEachTriangle(sheet, reached.m_low, reached.m_high, marks);
    return marks.m_sum;
}

// Adds extreme points: bounds alone do not distinguish cylinders of different axes, or a box from a wedge.
void addExtremes(std::uint64_t& mark, const btConvexShape& shape)
{
    constexpr int kDirections = 8;
    const btScalar s = 1 / btSqrt(btScalar(3));
    btVector3 directions[kDirections], extremes[kDirections];
    for (int k = 0; k < kDirections; ++k) directions[k].setValue(k & 1 ? s : -s, k & 2 ? s : -s, k & 4 ? s : -s);
    shape.batchedUnitVectorGetSupportingVertexWithoutMargin(directions, extremes, kDirections);
    for (const btVector3& extreme : extremes) addVector(mark, extreme);
}

void addConvex(std::uint64_t& mark, const btCollisionShape& shape)
{
    btVector3 low, high;
    shape.getAabb(btTransform::getIdentity(), low, high);
    addVector(mark, low);
    addVector(mark, high);
    if (shape.getShapeType() != CONVEX_HULL_SHAPE_PROXYTYPE)
        return addExtremes(mark, static_cast<const btConvexShape&>(shape));
    const auto& hull = static_cast<const btConvexHullShape&>(shape);
    for (int i = 0; i < hull.getNumPoints(); ++i) addVector(mark, hull.getUnscaledPoints()[i]);
}

// Hashes the domain and the values at the corners of the body's box.
void addField(std::uint64_t& mark, const btSdfCollisionShape& field, const MarkedBox& box)
{
    btVector3 low, high;
    field.getAabb(btTransform::getIdentity(), low, high);
    addVector(mark, low);
    addVector(mark, high);
    if (!isBox(box)) return;
    for (int k = 0; k < 8; ++k)
    {
        const Vec3 corner = {double(k & 1 ? box.m_low.x() : box.m_high.x()),
                             double(k & 2 ? box.m_low.y() : box.m_high.y()),
                             double(k & 4 ? box.m_low.z() : box.m_high.z())};
        SurfaceDistance d;
        if (pointFieldDistance(field, corner, std::numeric_limits<double>::infinity(), d)) addToMark(mark, d.m_gap);
    }
}

std::uint64_t markOf(const btCollisionShape& shape, const MarkedBox& box);

std::uint64_t markOfChild(const btCollisionShape& child, const btTransform& placement, const MarkedBox& box)
{
    std::uint64_t mark = markOf(child, inFrame(box, placement));
    addPlacement(mark, placement);
    return mark;
}

std::uint64_t markOfChildInside(const btCollisionShape& child, const btTransform& placement, const MarkedBox& box)
{
    btVector3 low, high;
    child.getAabb(placement, low, high);
    return TestAabbAgainstAabb2(low, high, box.m_low, box.m_high) ? markOfChild(child, placement, box) : 0;
}

// Traverses the compound's tree: a body is near a few children of possibly thousands.
std::uint64_t markOfBranch(const btCompoundShape& compound, const btDbvtNode* node, const MarkedBox& box)
{
    if (!node || !TestAabbAgainstAabb2(node->volume.Mins(), node->volume.Maxs(), box.m_low, box.m_high)) return 0;
    if (!node->isleaf())
        return markOfBranch(compound, node->childs[0], box) + markOfBranch(compound, node->childs[1], box);
    const int child = node->dataAsInt;
    return markOfChild(*compound.getChildShape(child), compound.getChildTransform(child), box);
}

// Sums the hashes of children: their order changes when Bullet removes one.
std::uint64_t markOfChildren(const btCompoundShape& compound, const MarkedBox& box)
{
    if (const btDbvt* tree = compound.getDynamicAabbTree()) return markOfBranch(compound, tree->m_root, box);
    std::uint64_t sum = 0;
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
        sum += markOfChildInside(*compound.getChildShape(i), compound.getChildTransform(i), box);
    return sum;
}

std::uint64_t markOfGImpact(const btGImpactShapeInterface& shape, const MarkedBox& box)
{
    std::uint64_t sum = 0;
    if (shape.getGImpactShapeType() == CONST_GIMPACT_TRIMESH_SHAPE)
    {
        const auto& mesh = static_cast<const btGImpactMeshShape&>(shape);
        for (int i = 0; i < mesh.getMeshPartCount(); ++i) sum += markOfSheet(*mesh.getMeshPart(i), box);
    }
    if (shape.getGImpactShapeType() == CONST_GIMPACT_COMPOUND_SHAPE)
        for (int i = 0; i < shape.getNumChildShapes(); ++i)
            sum += markOfChildInside(
                *shape.getChildShape(i),
                shape.childrenHasTransform() ? shape.getChildTransform(i) : btTransform::getIdentity(), box);
    return sum;
}

std::uint64_t markOf(const btCollisionShape& shape, const MarkedBox& box)
{
    std::uint64_t mark = kEmptyMark;
    addToMark(mark, shape.getShapeType());
    if (shape.isCompound())
        addToMark(mark, isBox(box) ? markOfChildren(static_cast<const btCompoundShape&>(shape), box) : 0);
    else if (shape.getShapeType() == GIMPACT_SHAPE_PROXYTYPE && !isKnownShape(shape))
        addToMark(mark, isBox(box) ? markOfGImpact(static_cast<const btGImpactShapeInterface&>(shape), box) : 0);
    else if (isKnownShape(shape))
    {
        addToMark(mark, shape.getMargin());
        addVector(mark, shape.getLocalScaling());
        if (shape.isConvex())
            addConvex(mark, shape);
        else if (const btSdfCollisionShape* field = fieldOf(shape))
            addField(mark, *field, box);
        else
            addToMark(mark, markOfSheet(shape, box));
    }
    return mark;
}

}  // namespace

std::uint64_t markOfShape(const btCollisionShape& shape, const btTransform& transform, const Vec3& low,
                          const Vec3& high)
{
    return markOf(shape, inFrame({bulletVector(low), bulletVector(high)}, transform));
}

}  // namespace bullet_fem
