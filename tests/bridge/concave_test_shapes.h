// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h"
#include "BulletCollision/CollisionShapes/btMultimaterialTriangleMeshShape.h"
#include "BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h"
#include "BulletCollision/Gimpact/btGImpactShape.h"
#include "btBulletDynamicsCommon.h"

namespace bullet_fem
{

/// Layout of a grid of triangles.
struct GridSettings
{
    int m_cells = 10;         ///< along each side
    btScalar m_halfSize = 2;  ///< [m]
    bool m_randomWinding = true;
    std::function<btScalar(btScalar, btScalar)> m_height = [](btScalar, btScalar) { return btScalar(0); };
};

/// Adds a square grid centred on the z axis, two triangles a cell.
inline void addGrid(btTriangleMesh& mesh, const GridSettings& settings)
{
    std::mt19937 random(3);
    const btScalar cell = 2 * settings.m_halfSize / btScalar(settings.m_cells);
    const auto corner = [&](int i, int j)
    {
        const btScalar x = btScalar(i) * cell - settings.m_halfSize, y = btScalar(j) * cell - settings.m_halfSize;
        return btVector3(x, y, settings.m_height(x, y));
    };
    const auto add = [&](const btVector3& a, const btVector3& b, const btVector3& c)
    {
        if (settings.m_randomWinding && random() % 2)
            mesh.addTriangle(a, c, b);
        else
            mesh.addTriangle(a, b, c);
    };
    for (int i = 0; i < settings.m_cells; ++i)
        for (int j = 0; j < settings.m_cells; ++j)
        {
            add(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1));
            add(corner(i, j), corner(i + 1, j + 1), corner(i, j + 1));
        }
}

/// A concave shape with the data that it refers to.
struct ConcaveShape
{
    std::unique_ptr<btTriangleMesh> m_mesh = std::make_unique<btTriangleMesh>();
    std::vector<btScalar> m_heights;
    std::vector<std::unique_ptr<btCollisionShape>> m_parts;  ///< the last one is the shape

    btCollisionShape& shape() const { return *m_parts.back(); }
    template <class Shape, class... Arguments>
    Shape& make(Arguments&&... arguments)
    {
        auto shape = std::make_unique<Shape>(std::forward<Arguments>(arguments)...);
        Shape& made = *shape;
        m_parts.push_back(std::move(shape));
        return made;
    }
};

/// A triangle mesh of the grid whose shape is not made yet.
inline ConcaveShape makeGrid(const GridSettings& settings)
{
    ConcaveShape shape;
    addGrid(*shape.m_mesh, settings);
    return shape;
}

inline ConcaveShape makeTriangleMesh(const GridSettings& settings = {})
{
    ConcaveShape shape = makeGrid(settings);
    shape.make<btBvhTriangleMeshShape>(shape.m_mesh.get(), true);
    return shape;
}

/// A mesh four times as large under btScaledBvhTriangleMeshShape, scaled back and mirrored in x.
inline ConcaveShape makeScaledMesh(GridSettings settings = {})
{
    settings.m_halfSize *= 4;
    ConcaveShape shape = makeGrid(settings);
    auto& mesh = shape.make<btBvhTriangleMeshShape>(shape.m_mesh.get(), true);
    shape.make<btScaledBvhTriangleMeshShape>(&mesh, btVector3(btScalar(-0.25), btScalar(0.25), 1));
    return shape;
}

inline ConcaveShape makeMultimaterialMesh(const GridSettings& settings = {})
{
    ConcaveShape shape = makeGrid(settings);
    shape.make<btMultimaterialTriangleMeshShape>(shape.m_mesh.get(), true);
    return shape;
}

/// A GImpact mesh without its default margin of 1 cm.
inline ConcaveShape makeGImpact(const GridSettings& settings = {})
{
    ConcaveShape shape = makeGrid(settings);
    auto& mesh = shape.make<btGImpactMeshShape>(shape.m_mesh.get());
    mesh.setMargin(0);
    mesh.updateBound();
    return shape;
}

/// A flat heightfield with its upper side at z = 0, scaled to the cells of the grid.
inline ConcaveShape makeHeightfield(const GridSettings& settings = {}, bool flip = false)
{
    ConcaveShape shape;
    const int points = settings.m_cells + 1;
    const btScalar cell = 2 * settings.m_halfSize / btScalar(settings.m_cells);
    for (int j = 0; j < points; ++j)
        for (int i = 0; i < points; ++i)
            shape.m_heights.push_back(
                settings.m_height(btScalar(i) * cell - settings.m_halfSize, btScalar(j) * cell - settings.m_halfSize));
    auto& field = shape.make<btHeightfieldTerrainShape>(points, points, shape.m_heights.data(), btScalar(1),
                                                        btScalar(-1), btScalar(1), 2, PHY_FLOAT, flip);
    field.setLocalScaling(btVector3(cell, cell, 1));
    return shape;
}

/// A user-defined concave shape that reports all its triangles for any box. Bullet takes a shape of the custom concave
/// type for a signed distance field when a rigid convex body meets it.
class OwnSheet : public btConcaveShape
{
public:
    explicit OwnSheet(btTriangleMesh& mesh, int type = CUSTOM_CONCAVE_SHAPE_TYPE) : m_mesh(mesh) { m_shapeType = type; }
    void getAabb(const btTransform& transform, btVector3& low, btVector3& high) const override
    {
        btVector3 localLow, localHigh;
        m_mesh.calculateAabbBruteForce(localLow, localHigh);
        btTransformAabb(localLow, localHigh, getMargin(), transform, low, high);
    }
    void processAllTriangles(btTriangleCallback* visitor, const btVector3&, const btVector3&) const override
    {
        struct Visit : btInternalTriangleIndexCallback
        {
            btTriangleCallback* m_visitor;
            void internalProcessTriangleIndex(btVector3* triangle, int part, int index) override
            {
                m_visitor->processTriangle(triangle, part, index);
            }
        } visit;
        visit.m_visitor = visitor;
        const btVector3 all(1e6, 1e6, 1e6);
        m_mesh.InternalProcessAllTriangles(&visit, -all, all);
    }
    void setLocalScaling(const btVector3&) override {}
    const btVector3& getLocalScaling() const override { return m_scaling; }
    void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
    const char* getName() const override { return "OwnSheet"; }

private:
    btTriangleMesh& m_mesh;
    btVector3 m_scaling{1, 1, 1};
};

inline ConcaveShape makeOwnSheet(const GridSettings& settings, int type)
{
    ConcaveShape shape = makeGrid(settings);
    shape.make<OwnSheet>(*shape.m_mesh, type).setMargin(0);
    return shape;
}

/// The mesh in a compound in a compound, at offsets whose sum is z = -2.
inline ConcaveShape makeNested(const GridSettings& settings = {})
{
    ConcaveShape shape = makeTriangleMesh(settings);
    btCollisionShape& mesh = shape.shape();
    auto& inner = shape.make<btCompoundShape>();
    btTransform place = btTransform::getIdentity();
    place.setOrigin({btScalar(0.125), 0, btScalar(-1.5)});
    inner.addChildShape(place, &mesh);
    auto& outer = shape.make<btCompoundShape>();
    place.setOrigin({btScalar(-0.125), 0, btScalar(-0.5)});
    outer.addChildShape(place, &inner);
    return shape;
}

/// A representation of the sheet in Bullet, with its name.
struct NamedConcave
{
    std::string m_name;
    std::function<ConcaveShape(const GridSettings&)> m_make;
    btScalar m_height = 0;  ///< of the sheet above the object's origin [m]
};

inline std::ostream& operator<<(std::ostream& out, const NamedConcave& shape)
{
    return out << shape.m_name;
}

inline std::vector<NamedConcave> concaveShapes()
{
    return {{"triangleMesh", [](const GridSettings& s) { return makeTriangleMesh(s); }},
            {"scaledMesh", [](const GridSettings& s) { return makeScaledMesh(s); }},
            {"multimaterialMesh", [](const GridSettings& s) { return makeMultimaterialMesh(s); }},
            {"gimpact", [](const GridSettings& s) { return makeGImpact(s); }},
            {"heightfield", [](const GridSettings& s) { return makeHeightfield(s); }},
            {"flippedHeightfield", [](const GridSettings& s) { return makeHeightfield(s, true); }},
            {"ownSheet", [](const GridSettings& s) { return makeOwnSheet(s, CUSTOM_CONCAVE_SHAPE_TYPE); }},
            {"ownMesh", [](const GridSettings& s) { return makeOwnSheet(s, TRIANGLE_MESH_SHAPE_PROXYTYPE); }},
            {"ownFastMesh", [](const GridSettings& s) { return makeOwnSheet(s, FAST_CONCAVE_MESH_PROXYTYPE); }},
            {"meshInCompound", [](const GridSettings& s) { return makeNested(s); }, -2}};
}

}  // namespace bullet_fem
