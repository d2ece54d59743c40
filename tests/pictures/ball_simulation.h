// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <stdexcept>

#include "pictures/picture_shapes.h"
#include "tools/pictures/viewer_simulation.h"

namespace bullet_fem
{

/// A ball that can be dragged in its plane z = 0, with two parameters. It counts the calls that it receives.
class BallSimulation : public ViewerSimulation
{
public:
    static constexpr double kRadius = 0.15;

    BallSimulation()
    {
        m_scene.m_camera.m_eye = {0, 0.8, 4};
        place({0.4, 0.5, 0});
    }

    void step() override { ++m_steps; }
    double timeStep() const override { return 1. / 60; }
    void setDrawnTime(double fraction) override { m_drawnTime = fraction; }
    const PictureScene& scene() override { return m_scene; }
    bool beginDrag(const PictureRay& ray) override
    {
        const Vec3 along = (1 / norm(ray.m_to - ray.m_from)) * (ray.m_to - ray.m_from);
        m_held = norm(cross(m_centre - ray.m_from, along)) < kRadius;
        m_rayLength = norm(ray.m_to - ray.m_from);
        return m_held;
    }
    void moveDrag(const PictureRay& ray) override
    {
        ++m_moves;
        place(ray.m_from + (ray.m_from.z / (ray.m_from.z - ray.m_to.z)) * (ray.m_to - ray.m_from));
    }
    void endDrag() override { m_held = false; }
    std::vector<ViewerParameter> parameters() const override
    {
        return {{"Young's modulus E", "Pa", m_values[0], 1e4, 1e8, true},
                {"Poisson's ratio \xce\xbd", "", m_values[1], 0, 0.49, false}};
    }
    void setParameter(std::size_t index, double value) override
    {
        if (m_refusal) throw std::invalid_argument(m_refusal);
        m_values[index] = value;
    }
    std::string status() const override { return "one ball"; }
    int views() const override { return m_views; }
    void update() override { ++m_updates; }
    void act(ViewerKey key, const PictureRay& cursor) override
    {
        m_keys.push_back(key);
        m_cursor = cursor;
    }
    void open(const std::vector<std::string>& files, const PictureRay& cursor) override
    {
        m_files = files;
        m_cursor = cursor;
    }
    ViewerProgress progress() const override { return m_progress; }
    std::string message() const override { return m_message; }

    void place(const Vec3& centre)
    {
        m_centre = centre;
        m_scene.m_meshes = {ball(centre, kRadius, 16)};
    }

    PictureScene m_scene;
    Vec3 m_centre;
    double m_values[2] = {1e6, 0.3}, m_rayLength = 0, m_drawnTime = 1;
    bool m_held = false;
    int m_steps = 0, m_moves = 0, m_views = 0, m_updates = 0;
    std::vector<ViewerKey> m_keys;
    std::vector<std::string> m_files;
    PictureRay m_cursor;
    ViewerProgress m_progress;
    std::string m_message;
    const char* m_refusal = nullptr;
};

}  // namespace bullet_fem
