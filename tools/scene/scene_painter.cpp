// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_painter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kCoolShare = 0.98;  // fraction of the vertices within the colour scale

Colour colourOf(const Vec3& c)
{
    return {c.x, c.y, c.z};
}

Vec3 upOf(const SceneDescription& scene)
{
    const double g = norm(scene.m_gravity);
    return g > 0 ? (-1 / g) * scene.m_gravity : Vec3{0, 1, 0};
}

// The ground is the first plane of the world.
PictureGround groundOf(const SceneWorld& world, double size)
{
    PictureGround ground;
    ground.m_shown = false;
    for (int i = 0; i < world.rigidCount() && !ground.m_shown; ++i)
    {
        if (world.description().m_rigidBodies[i].m_shape.m_kind != SceneShape::Kind::plane) continue;
        const btTransform& pose = world.rigid(i).getWorldTransform();
        ground.m_shown = true;
        ground.m_point = vec3(pose.getOrigin());
        ground.m_normal = vec3(pose.getBasis() * bulletVector(world.description().m_rigidBodies[i].m_shape.m_size));
        ground.m_gridSpacing = std::pow(10, std::floor(std::log10(size)));
    }
    return ground;
}

}  // namespace

SceneSnapshot snapshotOf(const SceneWorld& world, const SceneFrames& frames)
{
    const ScenePictures& pictures = world.description().m_pictures;
    SceneSnapshot snapshot;
    snapshot.m_time = world.time();
    for (std::size_t s = 0; s < frames.surfaces().size(); ++s)
    {
        const BodyFrame& surface = frames.surfaces()[s];
        snapshot.m_positions.push_back(surface.m_positions);
        snapshot.m_vonMises.emplace_back();
        snapshot.m_triangles.emplace_back();
        const int body = frames.bodyOf(int(s));
        if (body < world.softCount() && world.fractures().find(world.soft(body)))
            snapshot.m_triangles.back() = surface.m_triangles;
        if (!pictures.m_stress || body >= world.softCount()) continue;
        for (const Stress& stress : surface.m_nodeStress) snapshot.m_vonMises.back().push_back(vonMises(stress));
    }
    if (!pictures.m_forces) return snapshot;
    for (const BodyFrame& volume : frames.volumes())
        for (std::size_t n = 0; n < volume.m_contactForce.size(); ++n)
            if (norm(volume.m_contactForce[n]) > 0)
                snapshot.m_forces.push_back({volume.m_positions[n], volume.m_contactForce[n]});
    return snapshot;
}

double hottestOf(const std::vector<SceneSnapshot>& snapshots)
{
    double hottest = 1;
    std::vector<double> all;
    for (const SceneSnapshot& snapshot : snapshots)
    {
        all.clear();
        for (const std::vector<double>& values : snapshot.m_vonMises)
            all.insert(all.end(), values.begin(), values.end());
        if (all.empty()) continue;
        const auto last = all.begin() + static_cast<std::ptrdiff_t>(kCoolShare * double(all.size() - 1));
        std::nth_element(all.begin(), last, all.end());
        hottest = std::max(hottest, *last);
    }
    return hottest;
}

double largestForceOf(const std::vector<SceneSnapshot>& snapshots)
{
    double largest = 0;
    for (const SceneSnapshot& snapshot : snapshots)
        for (const PictureArrow& arrow : snapshot.m_forces) largest = std::max(largest, norm(arrow.m_vector));
    return largest;
}

ScenePainter::ScenePainter(const SceneWorld& world, const SceneFrames& frames, double size) : m_world(world)
{
    const SceneDescription& scene = world.description();
    for (std::size_t s = 0; s < frames.surfaces().size(); ++s)
    {
        const int body = frames.bodyOf(int(s));
        const bool soft = body < world.softCount();
        PictureMesh mesh;
        mesh.m_positions = frames.surfaces()[s].m_positions;
        mesh.m_triangles = frames.surfaces()[s].m_triangles;
        mesh.m_colour =
            colourOf(soft ? scene.m_softBodies[body].m_colour : scene.m_rigidBodies[body - world.softCount()].m_colour);
        mesh.m_wireframe = soft && scene.m_pictures.m_wireframe;
        m_picture.m_meshes.push_back(std::move(mesh));
    }
    m_size = size > 0 ? size : bounds(m_picture).radius();
    m_picture.m_ground = groundOf(world, m_size);
    if (scene.m_pictures.m_forces)
    {
        m_picture.m_arrows.emplace_back();
        m_picture.m_arrows.back().m_title = "contact force";
        m_picture.m_arrows.back().m_unit = "N";
    }
    m_picture.m_colourScale.m_high = scene.m_pictures.m_hottest > 0 ? scene.m_pictures.m_hottest : 1;
    m_picture.m_colourScale.m_title = "von Mises stress";
    m_picture.m_colourScale.m_unit = "Pa";
    placeCamera();
}

void ScenePainter::setLargestForce(double newton)
{
    for (PictureArrows& arrows : m_picture.m_arrows)
    {
        arrows.m_scale = 0.5 * m_size / newton;
        arrows.m_longest = newton;
    }
}

void ScenePainter::widenView(double factor)
{
    PictureCamera& camera = m_picture.m_camera;
    if (!m_world.description().m_camera.m_placed)
        camera.m_eye = camera.m_target + factor * (camera.m_eye - camera.m_target);
}

void ScenePainter::placeCamera()
{
    const SceneDescription& scene = m_world.description();
    const Vec3 up = upOf(scene);
    const PictureSize size = {scene.m_pictures.m_width, scene.m_pictures.m_height};
    PictureCamera& camera = m_picture.m_camera;
    camera.m_up = up;
    camera.m_fieldOfView = scene.m_camera.m_fieldOfView;
    m_picture.m_light.m_towards = up + Vec3{0.5, 0.3, 0.6};
    if (scene.m_camera.m_placed)
    {
        camera.m_eye = scene.m_camera.m_eye;
        camera.m_target = scene.m_camera.m_target;
    }
    else
        camera = framing(m_picture, scene.m_camera.m_direction, up, size);
}

const PictureScene& ScenePainter::paint(const SceneSnapshot& snapshot)
{
    for (std::size_t s = 0; s < m_picture.m_meshes.size(); ++s)
    {
        m_picture.m_meshes[s].m_positions = snapshot.m_positions[s];
        m_picture.m_meshes[s].m_scalars = snapshot.m_vonMises[s];
        if (!snapshot.m_triangles[s].empty()) m_picture.m_meshes[s].m_triangles = snapshot.m_triangles[s];
    }
    for (PictureArrows& arrows : m_picture.m_arrows) arrows.m_arrows = snapshot.m_forces;
    char time[32];
    std::snprintf(time, sizeof time, "%.2f s", snapshot.m_time);
    const std::string& title = m_world.description().m_title;
    m_picture.m_caption = title.empty() ? std::string(time) : title + ", " + time;
    return m_picture;
}

}  // namespace bullet_fem
