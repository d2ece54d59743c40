// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/materials.h"

#include <stdexcept>
#include <string>

#include "tools/scene/scene_world_materials.h"

namespace bullet_fem::python
{
namespace
{

void checkCount(const char* name, std::size_t found, int expected)
{
    if (found != 0 && found != std::size_t(expected))
        throw std::invalid_argument(std::string(name) + " has " + std::to_string(found) +
                                    " values: it must have one for each of the body's " + std::to_string(expected) +
                                    " elements");
}

}  // namespace

bool ElementMaterials::isOne() const
{
    return m_young.empty() && m_poisson.empty() && m_density.empty() && m_along.empty() && m_across.empty() &&
           m_labels.empty();
}

std::vector<btFemMaterial> ElementMaterials::expand(int count, const btMatrix3x3& turn) const
{
    checkCount("young_modulus", m_young.size(), count);
    checkCount("poisson_ratio", m_poisson.size(), count);
    checkCount("density", m_density.size(), count);
    checkCount("along", m_along.size(), count);
    checkCount("across", m_across.size(), count);
    checkCount("labels", m_labels.size(), count);
    std::vector<btFemMaterial> materials;
    materials.reserve(std::size_t(count));
    for (std::size_t e = 0; e < std::size_t(count); ++e)
    {
        Material material = m_base;
        if (!m_labels.empty())
        {
            const auto found = m_ofLabel.find(m_labels[e]);
            if (found == m_ofLabel.end())
                throw std::invalid_argument("element " + std::to_string(e) + " has label " +
                                            std::to_string(m_labels[e]) + ", which has no material");
            material = found->second;
        }
        if (!m_young.empty()) material.m_youngModulus = m_young[e];
        if (!m_poisson.empty()) material.m_poissonRatio = m_poisson[e];
        if (!m_density.empty()) material.m_density = m_density[e];
        if (!m_along.empty()) material.m_orthotropic.m_along = m_along[e];
        if (!m_across.empty()) material.m_orthotropic.m_across = m_across[e];
        material.validate();
        materials.push_back(materialOf(turned(material, turn)));
    }
    return materials;
}

}  // namespace bullet_fem::python
