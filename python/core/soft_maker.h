// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "python/core/materials.h"
#include "python/core/world.h"

namespace bullet_fem::python
{

/// A soft body to be added to a world.
struct SoftRequest
{
    const Mesh* m_mesh = nullptr;  ///< null: m_baked
    const BakedBody* m_baked = nullptr;
    ElementMaterials m_materials;  ///< ignored for a baked body
    btTransform m_pose;
    btVector3 m_velocity;  ///< [m/s]
    std::vector<int> m_pins;
    double m_friction = 0.5, m_restitution = 0;
    double m_contactOffset = 0;  ///< [m]
    bool m_selfContact = false;
    std::string m_name;
    int m_group = 1, m_mask = -1;
};

/// The settings by which a body with one material, or with one for each label, is baked for the world.
BakeSettings bakeSettings(const World& world, const SoftRequest& request);

/// Makes and adds the body, and returns its index. Throws std::invalid_argument or std::runtime_error; the world is
/// unchanged then.
int addSoft(World& world, const SoftRequest& request);

/// Fixes nodes. Throws std::out_of_range on one that the body does not have.
void setPins(SoftEntry& entry, const std::vector<int>& nodes);

/// Sets materials of a body of the world.
void setMaterials(World& world, SoftEntry& body, const ElementMaterials& materials);

}  // namespace bullet_fem::python
