// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_sliders.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"

namespace bullet_fem
{
namespace
{

enum Parameter
{
    kYoung,
    kPoisson,
    kDamping,
    kGravity
};

Vec3 downOf(const Vec3& gravity)
{
    const double length = norm(gravity);
    return length > 0 ? (1 / length) * gravity : Vec3{0, -1, 0};
}

// Scales all moduli of an orthotropic material; m_youngModulus equals that of axis 1.
void scaleStiffness(Material& material, double factor)
{
    for (auto* constants : {&material.m_orthotropic.m_young, &material.m_orthotropic.m_shear})
        for (double& value : *constants) value = std::clamp(factor * value, 1e-3, Orthotropic::kMaxModulus);
}

}  // namespace

SceneSliders::SceneSliders(SceneWorld& world) : m_world(world), m_down(downOf(world.description().m_gravity))
{
    update();
}

void SceneSliders::update()
{
    for (int i = static_cast<int>(m_materials.size()); i < m_world.softCount(); ++i)
        m_materials.push_back(m_world.materials(i));
}

std::vector<ViewerParameter> SceneSliders::parameters() const
{
    const Material first = m_materials.empty() ? Material() : m_materials[0].first();
    std::vector<ViewerParameter> all(4);
    all[kYoung] = {"Young's modulus", "Pa", first.m_youngModulus, 1e3, 1e10, true};
    all[kPoisson] = {"Poisson's ratio", "", first.m_poissonRatio, 0, Material::kMaxPoissonRatio, false};
    all[kDamping] = {"Stiffness damping", "s", first.m_stiffnessDamping, 0, 0.1, false};
    all[kGravity] = {"Gravity", "m/s\u00b2", norm(m_world.description().m_gravity), 0, 30, false};
    return all;
}

bool SceneSliders::set(std::size_t index, double value)
{
    switch (index)
    {
        case kYoung:
            setMaterials(&Material::m_youngModulus, value);
            return true;
        case kPoisson:
            setMaterials(&Material::m_poissonRatio, value);
            return true;
        case kDamping:
            setMaterials(&Material::m_stiffnessDamping, value);
            return true;
        case kGravity:
            m_world.setGravity(value * m_down);
            return false;
        default:
            return false;
    }
}

void SceneSliders::setMaterials(double Material::*member, double value)
{
    for (int i = 0; i < m_world.softCount(); ++i)
    {
        const double ratio = value / m_materials[i].first().*member;
        std::vector<btFemMaterial> ofRegion;
        for (MaterialRegion& region : m_materials[i].m_regions)
        {
            double& changed = region.m_material.*member;
            const bool keepsRatio = member == &Material::m_youngModulus && &region != &m_materials[i].m_regions.front();
            const double before = changed;
            changed = keepsRatio ? std::clamp(ratio * changed, 1e-3, 1e13) : value;
            if (member == &Material::m_youngModulus) scaleStiffness(region.m_material, changed / before);
            ofRegion.push_back(materialOf(region.m_material));
            ofRegion.back().m_density = 0;  // keeps node masses
        }
        if (m_materials[i].isUniform())
            m_world.fem().setMaterial(&m_world.soft(i), ofRegion.front());
        else
        {
            std::vector<btFemMaterial> perTet;
            for (const int region : m_materials[i].m_regionOf) perTet.push_back(ofRegion[region]);
            m_world.fem().setMaterials(&m_world.soft(i), perTet);
        }
        m_world.soft(i).activate();
    }
}

}  // namespace bullet_fem
