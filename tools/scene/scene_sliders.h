// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/pictures/viewer_simulation.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem
{

/// Sliders for materials and gravity. They show the first body's material and change one of its values for all bodies.
/// Regions keep the ratios of their Young's moduli.
class SceneSliders
{
public:
    /// The world must outlive this object.
    explicit SceneSliders(SceneWorld& world);

    std::vector<ViewerParameter> parameters() const;
    /// Returns whether materials have changed.
    bool set(std::size_t index, double value);
    /// Call after soft bodies were added.
    void update();

private:
    void setMaterials(double Material::*member, double value);

    SceneWorld& m_world;
    std::vector<ElementMaterials> m_materials;  // present materials of the soft bodies
    const Vec3 m_down;                          // unit vector
};

}  // namespace bullet_fem
