// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/pictures/viewer_simulation.h"
#include "tools/scene/scene_painter.h"

namespace bullet_fem
{

/// A scene in a window: the mouse pulls soft bodies by an implicit spring, sliders show the
/// first body's material, and change one value of it for all.
class SceneSimulation : public ViewerSimulation
{
public:
    /// The world must live longer.
    explicit SceneSimulation(SceneWorld& world);

    void step() override;
    double timeStep() const override { return m_world.description().m_step; }
    const PictureScene& scene() override;
    bool beginDrag(const PictureRay& ray) override;
    void moveDrag(const PictureRay& ray) override;
    void endDrag() override;
    std::vector<ViewerParameter> parameters() const override;
    void setParameter(std::size_t index, double value) override;
    std::string status() const override;

private:
    void setMaterials(double Material::*member, double value);
    void applyGravity();

    SceneWorld& m_world;
    SceneFrames m_frames;
    ScenePainter m_painter;
    std::vector<Material> m_materials;  // of the soft bodies
    double m_gravity;                   // [m/s2]
    btSoftBody* m_held = nullptr;
    int m_spring = 0;
    double m_holdDistance = 0;  // from the eye [m]
    double m_hottest = 1;       // so far [Pa]
    double m_largestForce = 0;  // so far [N]
};

}  // namespace bullet_fem
