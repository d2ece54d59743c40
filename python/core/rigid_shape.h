// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "LinearMath/btTransform.h"
#include "bullet_fem/fem/cage/surface_mesh.h"
#include "tools/scene/scene_description.h"

class btCollisionShape;
class btTriangleMesh;

namespace bullet_fem::python
{

/// A shape of rigid bodies, which may share it. All makers throw std::invalid_argument on sizes out of range.
class RigidShape
{
public:
    static RigidShape primitive(const SceneShape& shape);
    /// The convex hull of points [m].
    static RigidShape hull(const std::vector<Vec3>& points);
    /// A surface of triangles; only for bodies that no force moves.
    static RigidShape mesh(SurfaceMesh surface);

    /// A part of a compound in the compound's frame.
    struct Part
    {
        std::shared_ptr<const RigidShape> m_shape;
        btTransform m_pose;
    };
    static RigidShape compound(std::vector<Part> parts);
    /// For bodies that a scene owns.
    static RigidShape drawnOnly(const SceneShape& shape);

    btCollisionShape* shape() const { return m_shape.get(); }
    const SurfaceMesh& drawn() const { return m_drawn; }  ///< in its own frame [m]; empty for a plane
    bool isStaticOnly() const { return m_isStaticOnly; }

private:
    std::shared_ptr<btTriangleMesh> m_triangles;
    std::vector<Part> m_parts;
    std::shared_ptr<btCollisionShape> m_shape;
    SurfaceMesh m_drawn;
    bool m_isStaticOnly = false;
};

}  // namespace bullet_fem::python
