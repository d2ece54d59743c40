// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/pictures/viewer_simulation.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem
{

/// What sliders show and change: they show the first body's material, and change one value of it for all. Regions keep
/// the ratios of their Young's moduli.
class SceneSliders
{
public:
    /// The world must live longer.
    explicit SceneSliders(SceneWorld& world);

    std::vector<ViewerParameter> parameters() const;
    /// Returns whether materials have changed.
    bool set(std::size_t index, double value);
    /// Soft bodies have come.
    void update();

private:
    void setMaterials(double Material::*member, double value);

    SceneWorld& m_world;
    std::vector<ElementMaterials> m_materials;  // of the soft bodies, as they are now
    const Vec3 m_down;                          // of length 1
};

}  // namespace bullet_fem
