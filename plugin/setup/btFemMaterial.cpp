// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemMaterial.h"

#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/elastomer.h"
#include "fem/common/attempt.h"
#include "plugin/setup/btFemMaterialConversion.h"

namespace
{

btFemMaterial fromCore(const bullet_fem::Material& material)
{
    btFemMaterial result;
    result.m_youngModulus = static_cast<btScalar>(material.m_youngModulus);
    result.m_poissonRatio = static_cast<btScalar>(material.m_poissonRatio);
    result.m_density = static_cast<btScalar>(material.m_density);
    result.m_law = material.m_law;
    result.m_yieldStress = static_cast<btScalar>(material.m_yieldStress);
    result.m_hardeningModulus = static_cast<btScalar>(material.m_hardeningModulus);
    result.m_plasticCreep = static_cast<btScalar>(material.m_plasticCreep);
    result.m_mostPlasticStrain = static_cast<btScalar>(material.m_mostPlasticStrain);
    return result;
}

// With the damping of the preset, which fromCore() leaves at the default.
btFemMaterial fromElastomer(const bullet_fem::Material& material)
{
    btFemMaterial result = fromCore(material);
    result.m_stiffnessDamping = static_cast<btScalar>(material.m_stiffnessDamping);
    return result;
}

}  // namespace

static_assert(static_cast<int>(btFemMeanDilatation::off) == static_cast<int>(bullet_fem::MeanDilatation::off));
static_assert(static_cast<int>(btFemBending::accurate) == static_cast<int>(bullet_fem::Bending::accurate));

static_assert(btFemMaterial::kMaxRelaxationTerms == bullet_fem::Material::kMaxRelaxationTerms);

bullet_fem::Material coreMaterial(const btFemMaterial& material)
{
    bullet_fem::Material core;
    core.m_youngModulus = material.m_youngModulus;
    // The largest permitted ratio has no exact binary form: its single-precision value counts as that ratio.
    constexpr double kMax = bullet_fem::Material::kMaxPoissonRatio;
    core.m_poissonRatio = material.m_poissonRatio == btScalar(kMax) ? kMax : double(material.m_poissonRatio);
    core.m_density = material.m_density;
    core.m_massDamping = material.m_massDamping;
    core.m_stiffnessDamping = material.m_stiffnessDamping;
    core.m_meanDilatation = static_cast<bullet_fem::MeanDilatation>(material.m_meanDilatation);
    core.m_law = material.m_law;
    core.m_bending = static_cast<bullet_fem::Bending>(material.m_bending);
    core.m_yieldStress = material.m_yieldStress;
    core.m_hardeningModulus = material.m_hardeningModulus;
    core.m_plasticCreep = material.m_plasticCreep;
    core.m_mostPlasticStrain = material.m_mostPlasticStrain;
    constexpr double kMaxShare = bullet_fem::Material::kMaxRelaxedShare;  // as for kMax
    for (int i = 0; i < btFemMaterial::kMaxRelaxationTerms; ++i)
    {
        const btFemRelaxation& term = material.m_relaxation[i];
        core.m_relaxation[i].m_share = term.m_share == btScalar(kMaxShare) ? kMaxShare : double(term.m_share);
        core.m_relaxation[i].m_time = term.m_time;
    }
    for (int k = 0; k < bullet_fem::kMaxLawConstants; ++k) core.m_lawConstants[k] = material.m_lawConstants[k];
    const btFemOrthotropic& orthotropic = material.m_orthotropic;
    for (int i = 0; i < 3; ++i)
    {
        core.m_orthotropic.m_young[i] = orthotropic.m_young[i];
        core.m_orthotropic.m_poisson[i] = orthotropic.m_poisson[i];
        core.m_orthotropic.m_shear[i] = orthotropic.m_shear[i];
    }
    core.m_orthotropic.m_along = bullet_fem::vec3(orthotropic.m_along);
    core.m_orthotropic.m_across = bullet_fem::vec3(orthotropic.m_across);
    return core;
}

btFemMaterial btFemMaterial::transverselyIsotropic(btScalar youngAlong, btScalar youngAcross, btScalar poissonAlong,
                                                   btScalar poissonAcross, btScalar shearAlong)
{
    const bullet_fem::Orthotropic constants = bullet_fem::Orthotropic::transverselyIsotropic(
        youngAlong, youngAcross, poissonAlong, poissonAcross, shearAlong);
    btFemMaterial material;
    material.m_law = btFemElasticLaw::orthotropic;
    for (int i = 0; i < 3; ++i)
    {
        material.m_orthotropic.m_young[i] = static_cast<btScalar>(constants.m_young[i]);
        material.m_orthotropic.m_poisson[i] = static_cast<btScalar>(constants.m_poisson[i]);
        material.m_orthotropic.m_shear[i] = static_cast<btScalar>(constants.m_shear[i]);
    }
    return material;
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
btFemMaterial btFemMaterial::clay()
{
    return fromCore(bullet_fem::Material::clay());
}
btFemMaterial btFemMaterial::lead()
{
    return fromCore(bullet_fem::Material::lead());
}
btFemMaterial btFemMaterial::mildFoam()
{
    return fromCore(bullet_fem::Material::mildFoam());
}

btFemMaterial btFemMaterial::shoreA(btScalar hardness, std::string* why)
{
    return bullet_fem::attemptValue(why, [=] { return fromElastomer(bullet_fem::shoreA(hardness)); });
}
btFemMaterial btFemMaterial::shoreD(btScalar hardness, std::string* why)
{
    return bullet_fem::attemptValue(why, [=] { return fromElastomer(bullet_fem::shoreD(hardness)); });
}

bool btFemMaterial::setLossFactor(btScalar lossFactor, btScalar frequency, std::string* why)
{
    return bullet_fem::attempt(why,
                               [&]
                               {
                                   bullet_fem::Material core = coreMaterial(*this);
                                   bullet_fem::setLossFactor(core, lossFactor, frequency);
                                   m_stiffnessDamping = static_cast<btScalar>(core.m_stiffnessDamping);
                               });
}

btScalar btFemMaterial::lossFactor(btScalar frequency) const
{
    return static_cast<btScalar>(bullet_fem::lossFactor(coreMaterial(*this), frequency));
}

bool btFemMaterial::valid(std::string* why) const
{
    return coreMaterial(*this).valid(why);
}
