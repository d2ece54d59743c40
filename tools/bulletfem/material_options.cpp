// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/bulletfem/material_options.h"

#include "tools/console/option_range.h"

namespace bullet_fem
{

void MaterialOptions::add(CLI::App& command)
{
    command
        .add_option("--material", m_preset, "rubber, foam, jelly, flesh or wood (default: E 1e6 Pa, nu .3, 1000 kg/m3)")
        ->check(CLI::IsMember({"rubber", "foam", "jelly", "flesh", "wood"}));
    command.add_option("--young", m_young, "Young's modulus [Pa]")->check(inRange(1e-3, 1e13));
    command.add_option("--poisson", m_poisson, "Poisson's ratio [-]")->check(inRange(0, 0.49));
    command.add_option("--density", m_density, "density [kg/m3]")->check(inRange(1e-6, 1e6));
    command.add_option("--mass-damping", m_massDamping, "Rayleigh's alpha [1/s] (default 0)")->check(inRange(0, 1e4));
    command.add_option("--stiffness-damping", m_stiffnessDamping, "Rayleigh's beta [s] (default 0.005)")
        ->check(inRange(0, 10));
}

Material MaterialOptions::material() const
{
    Material material = m_preset == "rubber"  ? Material::rubber()
                        : m_preset == "foam"  ? Material::foam()
                        : m_preset == "jelly" ? Material::jelly()
                        : m_preset == "flesh" ? Material::flesh()
                        : m_preset == "wood"  ? Material::wood()
                                              : Material();
    material.m_stiffnessDamping = m_stiffnessDamping.value_or(0.005);  // as btFemMaterial
    material.m_youngModulus = m_young.value_or(material.m_youngModulus);
    material.m_poissonRatio = m_poisson.value_or(material.m_poissonRatio);
    material.m_density = m_density.value_or(material.m_density);
    material.m_massDamping = m_massDamping.value_or(material.m_massDamping);
    return material;
}

}  // namespace bullet_fem
