// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "BulletCollision/CollisionShapes/btBoxShape.h"
#include "BulletCollision/CollisionShapes/btCapsuleShape.h"
#include "BulletCollision/CollisionShapes/btConeShape.h"
#include "BulletCollision/CollisionShapes/btConvexHullShape.h"
#include "BulletCollision/CollisionShapes/btCylinderShape.h"
#include "BulletCollision/CollisionShapes/btMultiSphereShape.h"
#include "BulletCollision/CollisionShapes/btSphereShape.h"
#include "BulletCollision/CollisionShapes/btStaticPlaneShape.h"
#include "bullet_bridge/geometry/shapes/shape_distance.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{

using ShapePtr = std::unique_ptr<btCollisionShape>;

/// A shape's name and factory, for parameterised tests.
struct NamedShape
{
    std::string m_name;
    std::function<ShapePtr()> m_make;
    double m_pointAccuracy = 1e-9;     ///< accuracy of point gaps [m]: closed form, or a hull's exact corners
    double m_triangleAccuracy = 1e-9;  ///< accuracy of triangle gaps [m]: polytopes of round sides fall short by 1e-6
};

inline std::string shapeName(const ::testing::TestParamInfo<NamedShape>& info)
{
    return info.param.m_name;
}
inline std::ostream& operator<<(std::ostream& out, const NamedShape& shape)
{
    return out << shape.m_name;
}

template <class Shape>
ShapePtr withMargin(Shape shape, double margin)
{
    shape->setMargin(btScalar(margin));
    return shape;
}

inline ShapePtr boxHull(const btVector3& h, double margin)
{
    auto hull = std::make_unique<btConvexHullShape>();
    for (int i = 0; i < 8; ++i) hull->addPoint(h * btVector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    return withMargin(std::move(hull), margin);
}

inline ShapePtr twoSpheres()
{
    const btVector3 centres[] = {{-0.25f, 0, 0}, {0.5f, 0, 0}};
    const btScalar radii[] = {0.25f, 0.5f};
    return std::make_unique<btMultiSphereShape>(centres, radii, 2);
}

/// Convex solids of size about 1 with sharp edges as far as Bullet's margin allows.
inline std::vector<NamedShape> convexSolids()
{
    return {
        {"box", [] { return std::make_unique<btBoxShape>(btVector3(0.5f, 0.25f, 0.75f)); }},
        {"sphere", [] { return std::make_unique<btSphereShape>(btScalar(0.5)); }},
        {"capsuleX", [] { return std::make_unique<btCapsuleShapeX>(btScalar(0.25), btScalar(1)); }},
        {"capsuleY", [] { return std::make_unique<btCapsuleShape>(btScalar(0.25), btScalar(1)); }},
        {"capsuleZ", [] { return std::make_unique<btCapsuleShapeZ>(btScalar(0.25), btScalar(1)); }},
        {"cylinderX", [] { return std::make_unique<btCylinderShapeX>(btVector3(0.75f, 0.5f, 0.5f)); }, 1e-9, 3e-6},
        {"cylinderY", [] { return std::make_unique<btCylinderShape>(btVector3(0.5f, 0.75f, 0.5f)); }, 1e-9, 3e-6},
        {"cylinderZ", [] { return std::make_unique<btCylinderShapeZ>(btVector3(0.5f, 0.5f, 0.75f)); }, 1e-9, 3e-6},
        {"coneX", [] { return std::make_unique<btConeShapeX>(btScalar(0.5), btScalar(1)); }, 1e-9, 3e-6},
        {"coneY", [] { return std::make_unique<btConeShape>(btScalar(0.5), btScalar(1)); }, 1e-9, 3e-6},
        {"coneZ", [] { return std::make_unique<btConeShapeZ>(btScalar(0.5), btScalar(1)); }, 1e-9, 3e-6},
        {"hull",
         [] {
             return boxHull({0.5f, 0.25f, 0.75f}, 0.03125);
         }},
        {"multiSphere", [] { return twoSpheres(); }, 3e-6, 3e-6},
    };
}

/// The single leaf of a shape at a placement.
inline ShapeLeaf leafOf(btCollisionShape& shape, const btTransform& transform = btTransform::getIdentity())
{
    btCollisionObject object;
    object.setCollisionShape(&shape);
    object.setWorldTransform(transform);
    btAlignedObjectArray<ShapeLeaf> leaves;
    collectShapeLeaves(object, leaves);
    return leaves.at(0);
}

/// Repeatable random vectors and triangles.
class RandomPoints
{
public:
    Vec3 inBox(double halfSize)
    {
        std::uniform_real_distribution<double> d(-halfSize, halfSize);
        return {d(m_engine), d(m_engine), d(m_engine)};
    }
    std::array<Vec3, 3> triangle(double halfRange, double halfSize)
    {
        const Vec3 centre = inBox(halfRange);
        return {centre + inBox(halfSize), centre + inBox(halfSize), centre + inBox(halfSize)};
    }
    btTransform placement(double halfSize)
    {
        const Vec3 axis = inBox(1), origin = inBox(halfSize);
        return btTransform(btQuaternion(bulletVector(axis), btScalar(10 * axis.x)), bulletVector(origin));
    }

private:
    std::mt19937 m_engine{7};
};

inline Vec3 interpolate(const std::array<Vec3, 3>& t, const std::array<double, 3>& w)
{
    return t[0] * w[0] + t[1] * w[1] + t[2] * w[2];
}

}  // namespace bullet_fem
