// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemMaterial.h"

#include "plugin/setup/btFemMaterialConversion.h"

namespace
{

btFemMaterial fromCore(const bullet_fem::Material& material)
{
    btFemMaterial result;
    result.m_youngModulus = static_cast<btScalar>(material.m_youngModulus);
    result.m_poissonRatio = static_cast<btScalar>(material.m_poissonRatio);
    result.m_density = static_cast<btScalar>(material.m_density);
    return result;
}

}  // namespace

bullet_fem::Material coreMaterial(const btFemMaterial& material)
{
    bullet_fem::Material core;
    core.m_youngModulus = material.m_youngModulus;
    // The largest ratio allowed, .49, is not a binary number; what single precision makes of it is meant to be in
    // range.
    core.m_poissonRatio = material.m_poissonRatio == btScalar(0.49) ? 0.49 : double(material.m_poissonRatio);
    core.m_density = material.m_density;
    core.m_massDamping = material.m_massDamping;
    core.m_stiffnessDamping = material.m_stiffnessDamping;
    return core;
}

btFemMaterial btFemMaterial::rubber()
{
    return fromCore(bullet_fem::Material::rubber());
}
btFemMaterial btFemMaterial::foam()
{
    return fromCore(bullet_fem::Material::foam());
}
btFemMaterial btFemMaterial::jelly()
{
    return fromCore(bullet_fem::Material::jelly());
}
btFemMaterial btFemMaterial::flesh()
{
    return fromCore(bullet_fem::Material::flesh());
}
btFemMaterial btFemMaterial::wood()
{
    return fromCore(bullet_fem::Material::wood());
}

bool btFemMaterial::valid(std::string* why) const
{
    return coreMaterial(*this).valid(why);
}
