// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <map>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "btBulletDynamicsCommon.h"
#include "bullet_fem/io/body_frame.h"

namespace bullet_fem
{

/// Surfaces of all objects of Bullet worlds for pictures and files: faces or the embedded surface of soft bodies,
/// shapes of rigid bodies. Planes are left out because they are unbounded.
class DemoSurfaces
{
public:
    /// Updates the surfaces to the present state of one or several worlds. `frames()[i]` belongs to `objects()[i]`.
    void update(const std::vector<const btDynamicsWorld*>& worlds);

    const std::vector<BodyFrame>& frames() const { return m_frames; }
    const std::vector<const btCollisionObject*>& objects() const { return m_objects; }
    /// The first plane, the ground; null if there is none.
    const btCollisionObject* ground() const { return m_ground; }

private:
    struct Shape
    {
        std::vector<Vec3> m_points;  // in the object's frame [m]
        std::vector<Triangle> m_triangles;
    };
    void append(const btCollisionObject& object, int id);
    static Shape makeShape(const btCollisionShape& shape);
    const Shape& shapeOf(const btCollisionShape& shape);

    std::vector<BodyFrame> m_frames;
    std::vector<const btCollisionObject*> m_objects;
    const btCollisionObject* m_ground = nullptr;
    std::map<const btCollisionShape*, Shape> m_shapes;
};

}  // namespace bullet_fem
