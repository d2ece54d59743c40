// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/light_map.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

namespace bullet_fem
{
namespace
{

constexpr double kFarthestShadow = 20;  // below the scene [radii]: light at a low angle would need an unbounded map
constexpr double kFarthestCaster = 6;   // from the centre [radii]: the map is fitted around nearer casters
constexpr double kLowestLight = 1e-3;   // minimum sine of its elevation

/// Bounding box of the casters along the light's axes; z grows away from the light.
struct LightBox
{
    Vec3 m_u, m_v, m_w;  // m_w: away from the light
    Vec3 m_low{1e30, 1e30, 1e30}, m_high{-1e30, -1e30, -1e30};

    explicit LightBox(const Vec3& towardsLight) : m_w(-towardsLight)
    {
        const Vec3 aside = std::abs(m_w.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
        m_u = cross(aside, m_w);
        m_u *= 1 / norm(m_u);
        m_v = cross(m_w, m_u);
    }

    void add(const Vec3& x, const GroundPlane& ground)
    {
        const Vec3 q{dot(m_u, x), dot(m_v, x), dot(m_w, x)};
        for (int k = 0; k < 3; ++k)
        {
            m_low[k] = std::min(m_low[k], q[k]);
            m_high[k] = std::max(m_high[k], q[k]);
        }
        const double sine = -dot(m_w, ground.m_normal), height = dot(x - ground.m_point, ground.m_normal);
        if (ground.m_shown && sine > kLowestLight)
            m_high.z = std::max(m_high.z, q.z + std::min(height / sine, kFarthestShadow));
    }
};

}  // namespace

LightMap::LightMap(int side) : m_texture(makeGlTexture()), m_framebuffer(makeGlFramebuffer()), m_side(side)
{
    glBindTexture(GL_TEXTURE_2D, m_texture.id());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, side, side, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    const float farthest[] = {1, 1, 1, 1};
    glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, farthest);
    glBindFramebuffer(GL_FRAMEBUFFER, m_framebuffer.id());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, m_texture.id(), 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
}

void LightMap::render(const std::vector<PictureVertex>& casters, const Vec3& towardsLight, const GroundPlane& ground,
                      double margin, const std::function<void(const Matrix4&)>& draw)
{
    LightBox box(towardsLight);
    for (const PictureVertex& v : casters)
    {
        const Vec3 x{v.m_position[0], v.m_position[1], v.m_position[2]};
        if (norm(x) < kFarthestCaster) box.add(x, ground);
    }
    if (box.m_low.x > box.m_high.x) box.m_low = box.m_high = {};
    const double half = 0.5 * std::max(box.m_high.x - box.m_low.x, box.m_high.y - box.m_low.y) + margin;
    const Vec3 middle = 0.5 * (box.m_low + box.m_high);
    const double halfDepth = 0.5 * (box.m_high.z - box.m_low.z) + 0.02;
    const Vec3 axis[] = {box.m_u * (1 / half), box.m_v * (1 / half), box.m_w * (1 / halfDepth)};
    const double middles[] = {middle.x / half, middle.y / half, middle.z / halfDepth};
    Matrix4Rows clip, map;
    for (int i = 0; i < 3; ++i)
    {
        clip.m_row[i] = axis[i];
        clip.m_constant[i] = -middles[i];
        map.m_row[i] = 0.5 * axis[i];
        map.m_constant[i] = 0.5 - 0.5 * middles[i];
    }
    m_mapFromScene = matrix4(map);
    m_width = static_cast<float>(2 * half);
    m_depth = static_cast<float>(2 * halfDepth);

    glBindFramebuffer(GL_FRAMEBUFFER, m_framebuffer.id());
    glViewport(0, 0, m_side, m_side);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_CLAMP);  // geometry nearer to the light than the box casts shadows, too
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.5f, 4);
    draw(matrix4(clip));
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_DEPTH_CLAMP);
}

}  // namespace bullet_fem
