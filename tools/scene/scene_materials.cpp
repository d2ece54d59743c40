// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_materials.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "bullet_fem/fem/laws/law_table.h"
#include "bullet_fem/fem/mesh/elastomer.h"
#include "fem/common/bounds.h"

namespace bullet_fem
{
namespace
{

void readRelaxation(const JsonCursor& at, Material& material)
{
    const std::vector<JsonCursor> terms = at.items();
    if (terms.size() > material.m_relaxation.size()) at.expected("an array of at most 3 terms");
    double sum = 0;
    material.m_relaxation.fill({});
    for (std::size_t i = 0; i < terms.size(); ++i)
    {
        terms[i].onlyMembers({"share", "time"});
        PronyTerm& term = material.m_relaxation[i];
        term.m_share = terms[i]["share"].number({0, Material::kMaxRelaxedShare, true});
        term.m_time = terms[i]["time"].number({1e-6, 1e9});
        sum += term.m_share;
    }
    if (!isWithin(sum, 0, Material::kMaxRelaxedShare))
        at.fail("has shares whose sum is more than 0.99; a solid keeps some");
}

// Young's modulus of axis 1 is also that of the material, for displays of a single number.
void readOrthotropic(const JsonCursor& at, Material& material)
{
    at.onlyMembers({"young", "poisson", "shear", "axes"});
    Orthotropic& constants = material.m_orthotropic;
    const auto read = [&](const char* name, const JsonRange& range, std::array<double, 3>& values)
    {
        const Vec3 given = at[name].vector(range);
        values = {given.x, given.y, given.z};
    };
    read("young", {0, Orthotropic::kMaxModulus, true}, constants.m_young);
    read("poisson", {-100, 100}, constants.m_poisson);  // admissible combinations are checked by the material
    read("shear", {0, Orthotropic::kMaxModulus, true}, constants.m_shear);
    constants.m_along = Orthotropic().m_along;
    constants.m_across = Orthotropic().m_across;
    if (at.has("axes"))
    {
        const std::vector<JsonCursor> axes = at["axes"].items();
        if (axes.size() != 2) at["axes"].expected("an array of two directions, of axis 1 and of axis 2");
        constants.m_along = axes[0].direction();
        constants.m_across = axes[1].direction();
    }
    material.m_law = ElasticLaw::orthotropic;
    material.m_youngModulus = constants.m_young[0];
}

// Material whose values hold where the members give none.
Material baseMaterial(const JsonCursor& at, const SceneMaterials& known)
{
    if (int(at.has("like")) + int(at.has("shoreA")) + int(at.has("shoreD")) > 1)
        at.fail("has two of 'like', 'shoreA' and 'shoreD', which give all values; give one");
    if (at.has("shoreA")) return withProgramDefaults(shoreA(at["shoreA"].number({kMinShoreA, kMaxShoreA})));
    if (at.has("shoreD")) return withProgramDefaults(shoreD(at["shoreD"].number({kMinShoreD, kMaxShoreD})));
    return at.has("like") ? materialCalled(at["like"], known) : defaultMaterial();
}

// A law other than orthotropic, which has an object of its own; its constants are the defaults.
void readLaw(const JsonCursor& at, Material& material)
{
    ElasticLaw law = ElasticLaw::orthotropic;
    if (!findLaw(at.text(), law) || law == ElasticLaw::orthotropic)
        at.expected("a law that takes no axes: " + listOfLaws());
    if (law != material.m_law) material.m_lawConstants.fill(0);
    for (std::size_t k = 0; k < constantsOf(law).size() && law != material.m_law; ++k)
        material.m_lawConstants[k] = constantsOf(law)[k].m_default;
    material.m_law = law;
}

void readLawConstants(const JsonCursor& at, Material& material)
{
    const std::vector<LawConstant>& known = constantsOf(material.m_law);
    std::vector<std::string> names;
    const std::vector<JsonCursor> values = at.members(names);
    for (std::size_t i = 0; i < names.size(); ++i)
    {
        const auto named = [&](const LawConstant& constant) { return constant.m_name == names[i]; };
        const auto found = std::find_if(known.begin(), known.end(), named);
        if (found == known.end())
            at.fail("has '" + names[i].substr(0, 40) + "', which is no constant of the law " + nameOf(material.m_law));
        const std::size_t index = static_cast<std::size_t>(found - known.begin());
        material.m_lawConstants[index] = values[i].number({found->m_low, found->m_high});
    }
}

void readLoss(const JsonCursor& at, Material& material)
{
    if (!at.has("loss")) return;
    if (at.has("stiffnessDamping"))
        at.fail("has both 'loss' and 'stiffnessDamping', which the loss factor determines; give one");
    const JsonCursor loss = at["loss"];
    loss.onlyMembers({"factor", "frequency"});
    const double factor = loss["factor"].number({0, 2}), frequency = loss["frequency"].number({1e-3, 1e5});
    try
    {
        setLossFactor(material, factor, frequency);
    }
    catch (const std::invalid_argument& error)
    {
        loss.fail(std::string("is no damping: ") + error.what());
    }
}

}  // namespace

Material defaultMaterial()
{
    return withProgramDefaults({});
}

SceneMaterials presetMaterials()
{
    SceneMaterials presets = {{"rubber", Material::rubber()}, {"foam", Material::foam()},
                              {"jelly", Material::jelly()},   {"flesh", Material::flesh()},
                              {"wood", Material::wood()},     {"clay", Material::clay()},
                              {"lead", Material::lead()},     {"mildFoam", Material::mildFoam()}};
    for (auto& [name, material] : presets) material = withProgramDefaults(material);
    return presets;
}

const Material& materialCalled(const JsonCursor& at, const SceneMaterials& known)
{
    const auto found = known.find(at.text());
    if (found != known.end()) return found->second;
    std::string names;
    for (const auto& [name, value] : known) names += (names.empty() ? "" : ", ") + name.substr(0, 40);
    at.expected("the name of a material: " + names);
}

Material readMaterial(const JsonCursor& at, const SceneMaterials& known)
{
    at.onlyMembers({"like", "shoreA", "shoreD", "young", "poisson", "density", "massDamping", "stiffnessDamping",
                    "loss", "meanDilatation", "bending", "yieldStress", "hardening", "plasticCreep",
                    "mostPlasticStrain", "relaxation", "law", "lawConstants", "orthotropic"});
    if (at.has("law") && at.has("orthotropic")) at.fail("has both 'law' and 'orthotropic', which is a law; give one");
    Material material = baseMaterial(at, known);
    at.read("young", {0, 1e13, true}, material.m_youngModulus);
    at.read("poisson", {0, Material::kMaxPoissonRatio}, material.m_poissonRatio);
    at.read("density", {0, 1e6, true}, material.m_density);
    at.read("massDamping", {0, 1e4}, material.m_massDamping);
    at.read("stiffnessDamping", {0, 10}, material.m_stiffnessDamping);
    readLoss(at, material);
    if (at.has("meanDilatation"))
        material.m_meanDilatation = static_cast<MeanDilatation>(at["meanDilatation"].choice({"auto", "on", "off"}));
    if (at.has("bending"))
        material.m_bending = static_cast<Bending>(at["bending"].choice({"auto", "plain", "accurate"}));
    at.read("yieldStress", {0, 1e13, true}, material.m_yieldStress);
    at.read("hardening", {0, 1e13}, material.m_hardeningModulus);
    at.read("plasticCreep", {0, 1e9, true}, material.m_plasticCreep);
    at.read("mostPlasticStrain", {0, 0.9, true}, material.m_mostPlasticStrain);
    if (at.has("relaxation")) readRelaxation(at["relaxation"], material);
    if (at.has("law")) readLaw(at["law"], material);
    if (at.has("lawConstants")) readLawConstants(at["lawConstants"], material);
    if (at.has("orthotropic")) readOrthotropic(at["orthotropic"], material);
    std::string why;
    if (!material.valid(&why)) at.fail("is no material: " + why);
    return material;
}

}  // namespace bullet_fem
