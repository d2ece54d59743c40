// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_world_materials.h"

#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{

btFemMaterial materialOf(const Material& material)
{
    btFemMaterial result;
    result.m_youngModulus = btScalar(material.m_youngModulus);
    result.m_poissonRatio = btScalar(material.m_poissonRatio);
    result.m_density = btScalar(material.m_density);
    result.m_massDamping = btScalar(material.m_massDamping);
    result.m_stiffnessDamping = btScalar(material.m_stiffnessDamping);
    result.m_meanDilatation = static_cast<btFemMeanDilatation>(material.m_meanDilatation);
    result.m_law = material.m_law;
    result.m_bending = static_cast<btFemBending>(material.m_bending);
    result.m_yieldStress = btScalar(material.m_yieldStress);
    result.m_hardeningModulus = btScalar(material.m_hardeningModulus);
    result.m_plasticCreep = btScalar(material.m_plasticCreep);
    result.m_mostPlasticStrain = btScalar(material.m_mostPlasticStrain);
    for (std::size_t i = 0; i < material.m_relaxation.size(); ++i)
        result.m_relaxation[i] = {btScalar(material.m_relaxation[i].m_share),
                                  btScalar(material.m_relaxation[i].m_time)};
    for (std::size_t k = 0; k < material.m_lawConstants.size(); ++k)
        result.m_lawConstants[k] = btScalar(material.m_lawConstants[k]);
    const Orthotropic& orthotropic = material.m_orthotropic;
    for (int i = 0; i < 3; ++i)
    {
        result.m_orthotropic.m_young[i] = btScalar(orthotropic.m_young[i]);
        result.m_orthotropic.m_poisson[i] = btScalar(orthotropic.m_poisson[i]);
        result.m_orthotropic.m_shear[i] = btScalar(orthotropic.m_shear[i]);
    }
    result.m_orthotropic.m_along = bulletVector(orthotropic.m_along);
    result.m_orthotropic.m_across = bulletVector(orthotropic.m_across);
    return result;
}

Material turned(Material material, const btMatrix3x3& turn)
{
    for (Vec3* direction : {&material.m_orthotropic.m_along, &material.m_orthotropic.m_across})
        *direction = vec3(turn * bulletVector((1 / norm(*direction)) * *direction));
    return material;
}

}  // namespace bullet_fem
