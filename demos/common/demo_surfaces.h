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

/// The surfaces of all objects of a Bullet world, as pictures and files take them: of soft bodies their faces, or the
/// surface that follows them; of rigid ones their shapes. Planes have none: they are endless.
class DemoSurfaces
{
public:
    /// Takes them as they are now. `frames()[i]` is of `objects()[i]`.
    void update(const btDynamicsWorld& world);

    const std::vector<BodyFrame>& frames() const { return m_frames; }
    const std::vector<const btCollisionObject*>& objects() const { return m_objects; }
    /// Of the world's first plane, the ground [m]; null where there is none.
    const btCollisionObject* ground() const { return m_ground; }

private:
    struct Shape
    {
        std::vector<Vec3> m_points;  // in the object's frame [m]
        std::vector<Triangle> m_triangles;
    };
    static Shape makeShape(const btCollisionShape& shape);
    const Shape& shapeOf(const btCollisionShape& shape);

    std::vector<BodyFrame> m_frames;
    std::vector<const btCollisionObject*> m_objects;
    const btCollisionObject* m_ground = nullptr;
    std::map<const btCollisionShape*, Shape> m_shapes;
};

}  // namespace bullet_fem
