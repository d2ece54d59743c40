// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <vector>

#include "tools/pictures/gl_objects.h"
#include "tools/pictures/matrix4.h"
#include "tools/pictures/mesh_vertices.h"

namespace bullet_fem
{

/// The ground plane, in PictureUnits.
struct GroundPlane
{
    bool m_shown = false;
    Vec3 m_point, m_normal{0, 1, 0};  ///< the normal is a unit vector
};

/// A shadow map: depths along parallel light rays, over the scene and the ground below it.
class LightMap
{
public:
    explicit LightMap(int side);

    /// Fits the map around `casters`, leaving `margin` free, and calls `draw`, which must draw them with the matrix
    /// `clipFromScene`. `towardsLight` is a unit vector.
    void render(const std::vector<PictureVertex>& casters, const Vec3& towardsLight, const GroundPlane& ground,
                double margin, const std::function<void(const Matrix4& clipFromScene)>& draw);

    unsigned texture() const { return m_texture.id(); }
    const Matrix4& mapFromScene() const { return m_mapFromScene; }  ///< to [0, 1]^3
    float width() const { return m_width; }                         ///< of the square covered by the map
    float depth() const { return m_depth; }                         ///< of the box covered by the map

private:
    GlObject m_texture, m_framebuffer;
    int m_side;
    Matrix4 m_mapFromScene{};
    float m_width = 1, m_depth = 1;
};

}  // namespace bullet_fem
