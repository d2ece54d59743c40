// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/material.h"

#include <algorithm>

#include "fem/common/bounds.h"
#include "fem/common/message.h"
#include "fem/laws/law.h"

namespace bullet_fem
{
namespace
{

constexpr double kProgramDamping = 0.005;  // stiffness damping that a program starts from [s], as of btFemMaterial

/// An allowed range of a material value: (low, high] or [low, high].
struct ValueRange
{
    const char* m_what;
    double m_value;
    bool m_openBelow;
    double m_low, m_high;
    const char* m_remedy;

    bool contains() const  // false for NaN
    {
        return (!m_openBelow || m_value > m_low) && isWithin(m_value, m_low, m_high);
    }
    std::string complaint() const
    {
        return message(m_what, " is ", m_value, ", outside ", m_openBelow ? "(" : "[", m_low, ", ", m_high, "]; ",
                       m_remedy);
    }
};

Material isotropic(double youngModulus, double poissonRatio, double density, ElasticLaw law = ElasticLaw::hooke)
{
    Material material;
    material.m_youngModulus = youngModulus;
    material.m_poissonRatio = poissonRatio;
    material.m_density = density;
    material.m_law = law;
    return material;
}

// Returns false and the reason for an invalid Prony series.
bool validRelaxation(const std::array<PronyTerm, Material::kMaxRelaxationTerms>& terms, std::string* why)
{
    double sum = 0;
    bool isOver = false;  // true after a term without share
    for (int i = 0; i < Material::kMaxRelaxationTerms; ++i)
    {
        const PronyTerm& term = terms[i];
        const std::string name = message("relaxation term ", i);
        const ValueRange ranges[] = {{"share [-]", term.m_share, false, 0, Material::kMaxRelaxedShare, "0 is no term"},
                                     {"time [s]", term.m_time, false, 1e-6, 1e9, "usual ones are 0.01 to 1000 s"}};
        for (const ValueRange& range : ranges)
            if (!range.contains())
            {
                if (why) *why = message(name, ": ", range.complaint());
                return false;
            }
        if (isOver && term.m_share > 0)
        {
            if (why)
                *why = message(name, ": its share is ", term.m_share, ", and a term before it has none; close the gap");
            return false;
        }
        isOver = term.m_share == 0;
        sum += term.m_share;
    }
    const ValueRange all = {"sum of the relaxation terms' shares [-]", sum, false, 0, Material::kMaxRelaxedShare,
                            "a solid keeps some of its stiffness"};
    if (!all.contains() && why) *why = all.complaint();
    return all.contains();
}

// Returns false and the reason for an invalid law, or one that conflicts with other values.
bool validLaw(const Material& material, std::string* why)
{
    const auto refuse = [why](const std::string& text)
    {
        if (why) *why = text;
        return false;
    };
    const int last = static_cast<int>(allLaws().size()) - 1;
    if (static_cast<int>(material.m_law) < 0 || static_cast<int>(material.m_law) > last)
        return refuse(message("elastic law is ", static_cast<int>(material.m_law), ", outside [0, ", last,
                              "]; choose one of: ", listOfLaws()));
    const Law& law = lawOf(material.m_law);
    if (!areLawConstants(law, material.m_lawConstants.data(), why)) return false;
    if (law.m_kind == LawKind::linear) return true;
    if (material.yields())
        return refuse(message("yield stress [Pa] is ", material.m_yieldStress, " with the ", law.m_title,
                              ", which does not yield; use infinity, or the law hooke"));
    if (material.m_relaxation[0].m_share > 0)
        return refuse(message("relaxation term 0: its share is ", material.m_relaxation[0].m_share, " with the ",
                              law.m_title, ", which does not relax; use none, or the law hooke"));
    if (material.m_meanDilatation == MeanDilatation::on && law.m_noPatches)
        return refuse(message("mean dilatation is on with the ", law.m_title, ", which ", law.m_noPatches,
                              "; use automatic or off, or the law hooke"));
    return !material.isOrthotropic() || material.m_orthotropic.valid(why);
}

// Returns false and the reason if accurate bending conflicts with other values.
bool validBending(const Material& material, std::string* why)
{
    if (material.m_bending < Bending::automatic || material.m_bending > Bending::accurate)
    {
        if (why)
            *why = message("bending is ", static_cast<int>(material.m_bending),
                           ", outside [0, 2]; choose automatic, plain or accurate");
        return false;
    }
    if (material.m_bending != Bending::accurate || material.m_meanDilatation != MeanDilatation::off) return true;
    if (why) *why = "accurate bending does not go with mean dilatation off; take automatic or on";
    return false;
}

}  // namespace

double Material::lameLambda() const
{
    if (isOrthotropic()) return m_orthotropic.isotropicPart().m_lambda;
    return lawOf(m_law).m_moduli(m_lawConstants.data(), m_youngModulus, m_poissonRatio).m_lambda;
}

double Material::lameMu() const
{
    if (isOrthotropic()) return m_orthotropic.isotropicPart().m_mu;
    return lawOf(m_law).m_moduli(m_lawConstants.data(), m_youngModulus, m_poissonRatio).m_mu;
}

ElasticMatrix Material::stiffness() const
{
    return isOrthotropic() ? m_orthotropic.stiffness() : isotropicStiffness({lameMu(), lameLambda()});
}

bool Material::usesMeanDilatation() const
{
    const Law& law = lawOf(m_law);
    if (m_bending == Bending::accurate) return m_meanDilatation != MeanDilatation::off;
    if (law.m_noPatches) return false;
    if (m_meanDilatation != MeanDilatation::automatic) return m_meanDilatation == MeanDilatation::on;
    if (law.m_kind != LawKind::linear) return false;
    return static_cast<float>(m_poissonRatio) > static_cast<float>(kMinAveragedRatio);
}

int Material::relaxationTerms() const
{
    int count = 0;
    while (count < kMaxRelaxationTerms && m_relaxation[count].m_share > 0) ++count;
    return count;
}

double Material::slowCompliance(const Vec3& direction) const
{
    if (isOrthotropic()) return m_orthotropic.compliance(direction);
    double kept = 1;
    for (const PronyTerm& term : m_relaxation) kept -= term.m_share;
    const double bulk = lameLambda() + 2.0 / 3 * lameMu(), mu = kept * lameMu();
    return 1 / LameModuli{mu, bulk - 2.0 / 3 * mu}.youngModulus();
}

bool Material::valid(std::string* why) const
{
    const ValueRange ranges[] = {
        {"Young's modulus [Pa]", m_youngModulus, true, 0, 1e13, "rubber is about 2e6, steel 2e11"},
        {"Poisson's ratio [-]", m_poissonRatio, false, 0, kMaxPoissonRatio,
         "use 0.45 to 0.499 for a nearly incompressible solid: at 0.5 no pressure would change its volume"},
        {"density [kg/m3]", m_density, false, 0, 1e6, "water is 1000; 0 keeps the body's own node masses"},
        {"mass damping [1/s]", m_massDamping, false, 0, 1e4, "0 switches it off"},
        {"stiffness damping [s]", m_stiffnessDamping, false, 0, 10, "0 switches it off, 0.01 is already much"},
        {"yield stress [Pa]", m_yieldStress, true, 0, kInfinite,
         "soft clay yields at 5e4, mild steel at 2.5e8; infinity, the default, never yields"},
        {"hardening modulus [Pa]", m_hardeningModulus, false, 0, 1e13, "0 is perfect plasticity"},
        {"plastic creep [1/s]", m_plasticCreep, true, 0, kInfinite, "infinity, the default, flows at once"},
        {"largest plastic strain [-]", m_mostPlasticStrain, true, 0, 0.9,
         "at 1 elements would be flat at rest; 0.5 is the default"}};
    for (const ValueRange& range : ranges)
        if (!range.contains())
        {
            if (why) *why = range.complaint();
            return false;
        }
    if (m_meanDilatation < MeanDilatation::automatic || m_meanDilatation > MeanDilatation::off)
    {
        if (why)
            *why = message("mean dilatation is ", static_cast<int>(m_meanDilatation),
                           ", outside [0, 2]; choose automatic, on or off");
        return false;
    }
    return validLaw(*this, why) && validRelaxation(m_relaxation, why) && validBending(*this, why);
}

void Material::validate() const
{
    std::string why;
    if (!valid(&why)) reject(why);
}

Material Material::rubber()
{
    return isotropic(2e6, 0.47, 1100);
}
Material Material::foam()
{
    return isotropic(5e4, 0.1, 40);
}
Material Material::jelly()
{
    return isotropic(1e4, 0.45, 1000, ElasticLaw::neoHooke);
}
Material Material::flesh()
{
    return isotropic(6e4, 0.45, 1060, ElasticLaw::neoHooke);
}
Material Material::wood()
{
    return isotropic(9e9, 0.3, 500);
}

// Sources: docs/materials.md, Plasticity.
Material Material::clay()
{
    Material material = isotropic(2.5e6, 0.45, 1800);
    material.m_yieldStress = 5e4;
    return material;
}
Material Material::lead()
{
    Material material = isotropic(16e9, 0.44, 11340);
    material.m_yieldStress = 5.5e6;
    material.m_hardeningModulus = 20e6;
    return material;
}
Material Material::mildFoam()
{
    Material material = foam();
    material.m_yieldStress = 2.5e3;
    material.m_plasticCreep = 2;
    return material;
}

Material withProgramDefaults(Material material)
{
    material.m_bending = Bending::automatic;
    if (material.m_stiffnessDamping == 0) material.m_stiffnessDamping = kProgramDamping;
    return material;
}

}  // namespace bullet_fem
