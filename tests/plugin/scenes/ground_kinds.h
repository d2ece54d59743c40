// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <ostream>
#include <utility>
#include <vector>

#include "bridge/concave_test_shapes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// Representations in Bullet of a flat static ground, or of a block.
enum class GroundKind
{
    plane,  ///< flat ground alone
    box,
    hull,
    compound,    ///< four boxes
    mesh,        ///< btBvhTriangleMeshShape
    coarseMesh,  ///< two triangles a side
    gimpact,
    heightfield  ///< flat ground alone
};

inline const char* nameOf(GroundKind kind)
{
    const char* names[] = {"Plane", "Box", "Hull", "Compound", "Mesh", "CoarseMesh", "GImpact", "Heightfield"};
    return names[static_cast<int>(kind)];
}

inline std::ostream& operator<<(std::ostream& out, GroundKind kind)
{
    return out << nameOf(kind);
}

/// Grounds and blocks with the data that they refer to; must outlive the world.
class Grounds
{
public:
    /// A ground whose upper side is z = 0, of these half edges [m].
    btRigidBody& addFlat(SoftWorld& world, GroundKind kind, double half)
    {
        const auto h = btScalar(half);
        GridSettings grid;
        grid.m_halfSize = h;
        grid.m_cells = kind == GroundKind::coarseMesh ? 1 : 10;
        switch (kind)
        {
            case GroundKind::plane:
                return add(world, new btStaticPlaneShape(btVector3(0, 0, 1), 0), 0);
            case GroundKind::mesh:
            case GroundKind::coarseMesh:
                return addConcave(world, makeTriangleMesh(grid), 0);
            case GroundKind::gimpact:
                return addConcave(world, makeGImpact(grid), 0);
            case GroundKind::heightfield:
                return addConcave(world, makeHeightfield(grid), 0);
            default:
                return addBlock(world, kind, btVector3(h, h, h));
        }
    }

    /// A block of these half edges [m] whose upper side is z = 0.
    btRigidBody& addBlock(SoftWorld& world, GroundKind kind, const btVector3& half)
    {
        std::vector<btVector3> corners;
        for (int k = 0; k < 8; ++k)
            corners.emplace_back(k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(),
                                 k & 4 ? half.z() : -half.z());
        switch (kind)
        {
            case GroundKind::hull:
            {
                auto* hull = new btConvexHullShape;
                hull->setMargin(0);
                for (const btVector3& corner : corners) hull->addPoint(corner);
                return add(world, hull, -half.z());
            }
            case GroundKind::compound:
            {
                auto* compound = new btCompoundShape;
                for (int k = 0; k < 4; ++k)
                    compound->addChildShape(
                        at(k & 1 ? half.x() / 2 : -half.x() / 2, k & 2 ? half.y() / 2 : -half.y() / 2, 0),
                        world.keep(new btBoxShape(half * btVector3(0.5, 0.5, 1))));
                return add(world, compound, -half.z());
            }
            case GroundKind::mesh:
            case GroundKind::coarseMesh:
            case GroundKind::gimpact:
            {
                ConcaveShape shape;
                const int faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
                for (const auto& f : faces)
                {
                    shape.m_mesh->addTriangle(corners[f[0]], corners[f[1]], corners[f[2]]);
                    shape.m_mesh->addTriangle(corners[f[0]], corners[f[2]], corners[f[3]]);
                }
                if (kind != GroundKind::gimpact)
                    shape.make<btBvhTriangleMeshShape>(shape.m_mesh.get(), true);
                else
                {
                    auto& mesh = shape.make<btGImpactMeshShape>(shape.m_mesh.get());
                    mesh.setMargin(0);
                    mesh.updateBound();
                }
                return addConcave(world, std::move(shape), -half.z());
            }
            default:
                return add(world, new btBoxShape(half), -half.z());
        }
    }

    /// A mesh of triangles, three corners each [m].
    btRigidBody& addTriangles(SoftWorld& world, const std::vector<btVector3>& corners, bool gimpact = false)
    {
        ConcaveShape shape;
        for (std::size_t k = 0; k + 2 < corners.size(); k += 3)
            shape.m_mesh->addTriangle(corners[k], corners[k + 1], corners[k + 2]);
        if (!gimpact)
            shape.make<btBvhTriangleMeshShape>(shape.m_mesh.get(), true);
        else
        {
            auto& mesh = shape.make<btGImpactMeshShape>(shape.m_mesh.get());
            mesh.setMargin(0);
            mesh.updateBound();
        }
        return addConcave(world, std::move(shape), 0);
    }

private:
    static btRigidBody& add(SoftWorld& world, btCollisionShape* shape, btScalar z)
    {
        RigidSettings settings;
        settings.m_transform = at(0, 0, z);
        return world.addRigid(shape, settings);
    }

    btRigidBody& addConcave(SoftWorld& world, ConcaveShape shape, btScalar z)
    {
        m_shapes.push_back(std::move(shape));
        btCollisionShape* made = m_shapes.back().m_parts.back().release();
        m_shapes.back().m_parts.pop_back();
        return add(world, made, z);
    }

    std::vector<ConcaveShape> m_shapes;
};

}  // namespace bullet_fem
