// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/bulletfem/material_options.h"

#include <charconv>
#include <cstdlib>
#include <exception>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "bullet_fem/fem/mesh/elastomer.h"
#include "tools/console/option_range.h"

namespace bullet_fem
{
namespace
{

const std::map<std::string, Material> kPresets = {{"rubber", Material::rubber()}, {"foam", Material::foam()},
                                                  {"jelly", Material::jelly()},   {"flesh", Material::flesh()},
                                                  {"wood", Material::wood()},     {"clay", Material::clay()},
                                                  {"lead", Material::lead()},     {"mildFoam", Material::mildFoam()}};

constexpr const char* kRegionForm =
    "; give its label and what it is made of, as 7:rubber, 7:shoreA=40 or 7:rubber,young=2e5,poisson=.45,density=1100";

double valueOf(const std::string& text)
{
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != 0) throw std::runtime_error("'" + text + "' is no number");
    return value;
}

// Takes a region's preset; settings of the body stay.
void takePreset(const Material& preset, Material& material)
{
    const Material body = material;
    material = preset;
    material.m_massDamping = body.m_massDamping;
    material.m_stiffnessDamping = body.m_stiffnessDamping;
    material.m_meanDilatation = body.m_meanDilatation;
    material.m_bending = body.m_bending;
}

// Parses a preset, or the name of a value and the value.
void take(const std::string& part, Material& material)
{
    const std::size_t sign = part.find('=');
    if (sign == std::string::npos)
    {
        const auto preset = kPresets.find(part);
        if (preset == kPresets.end()) throw std::runtime_error("'" + part + "' is no material");
        return takePreset(preset->second, material);
    }
    const std::string name = part.substr(0, sign);
    if (name == "shoreA") return takePreset(shoreA(valueOf(part.substr(sign + 1))), material);
    if (name == "shoreD") return takePreset(shoreD(valueOf(part.substr(sign + 1))), material);
    double Material::*const member = name == "young"     ? &Material::m_youngModulus
                                     : name == "poisson" ? &Material::m_poissonRatio
                                     : name == "density" ? &Material::m_density
                                                         : nullptr;
    if (!member) throw std::runtime_error("'" + name + "' is no value of a region");
    material.*member = valueOf(part.substr(sign + 1));
}

// Parses a label and a material.
void takeRegion(const std::string& text, Material material, std::optional<ElasticLaw> law,
                std::map<int, Material>& regions)
{
    int label = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, label);
    if (error != std::errc() || end == last || *end != ':') throw std::runtime_error("it has no label with ':' behind");
    std::istringstream parts(std::string(end + 1, last));
    int count = 0;
    for (std::string part; std::getline(parts, part, ','); ++count) take(part, material);
    if (count == 0) throw std::runtime_error("there is no material");
    material.m_law = law.value_or(material.m_law);
    material.validate();
    if (!regions.emplace(label, material).second) throw std::runtime_error("its region was given before");
}

}  // namespace

std::map<int, Material> MaterialOptions::regions() const
{
    const std::optional<ElasticLaw> given = law();
    std::map<int, Material> regions;
    for (const std::string& text : m_regions)
    {
        try
        {
            takeRegion(text, material(), given, regions);
        }
        catch (const std::exception& error)
        {
            throw std::runtime_error("--region " + text + ": " + error.what() + kRegionForm);
        }
    }
    return regions;
}

void MaterialOptions::add(CLI::App& command)
{
    command
        .add_option("--material", m_preset,
                    "rubber, foam, jelly, flesh, wood, clay, lead or mildFoam (default: E 1e6 Pa, nu .3, 1000 kg/m3)")
        ->check(CLI::IsMember({"rubber", "foam", "jelly", "flesh", "wood", "clay", "lead", "mildFoam"}));
    auto* const hardnessA = command.add_option("--shore-a", m_shoreA, "rubber of this hardness [Shore A]");
    hardnessA->check(inRange(kMinShoreA, kMaxShoreA))->excludes("--material");
    command.add_option("--shore-d", m_shoreD, "hard rubber or thermoplastic elastomer of this hardness [Shore D]")
        ->check(inRange(kMinShoreD, kMaxShoreD))
        ->excludes("--material")
        ->excludes(hardnessA);
    command.add_option("--young", m_young, "Young's modulus [Pa]")->check(inRange(1e-3, 1e13));
    command.add_option("--poisson", m_poisson, "Poisson's ratio [-]")->check(inRange(0, Material::kMaxPoissonRatio));
    command.add_option("--density", m_density, "density [kg/m3]")->check(inRange(1e-6, 1e6));
    command.add_option("--mass-damping", m_massDamping, "Rayleigh's alpha [1/s] (default 0)")->check(inRange(0, 1e4));
    command.add_option("--stiffness-damping", m_stiffnessDamping, "Rayleigh's beta [s] (default 0.005)")
        ->check(inRange(0, 10));
    command
        .add_option("--loss", m_loss,
                    "in place of --stiffness-damping: loss factor [-] and the frequency [Hz] that it is for")
        ->expected(2)
        ->excludes("--stiffness-damping");
    command
        .add_option(
            "--mean-dilatation", m_meanDilatation,
            "auto, on or off: volume changes are averaged over neighbouring elements (default auto: above nu .4)")
        ->check(CLI::IsMember({"auto", "on", "off"}));
    command
        .add_option(
            "--bending", m_bending,
            "plain, accurate (assumed strains, so that few cells bend as they should) or auto: accurate in bodies "
            "with fewer than four cells across somewhere (default auto)")
        ->check(CLI::IsMember({"plain", "accurate", "auto"}));
    command
        .add_option("--law", m_law,
                    "hooke, or neoHooke, which stiffens in tension and compression (default: the material's; that of "
                    "jelly and flesh is neoHooke)")
        ->check(CLI::IsMember({"hooke", "neoHooke"}));
    command
        .add_option("--region", m_regions,
                    "material of a region of the file, by its label: 7:rubber or 7:young=2e5,poisson=.45,density=1100; "
                    "give it for every region")
        ->allow_extra_args(false);
}

Material MaterialOptions::base() const
{
    return withProgramDefaults(m_shoreA           ? shoreA(*m_shoreA)
                               : m_shoreD         ? shoreD(*m_shoreD)
                               : m_preset.empty() ? Material()
                                                  : kPresets.at(m_preset));
}

Material MaterialOptions::material() const
{
    Material material = base();
    material.m_stiffnessDamping = m_stiffnessDamping.value_or(material.m_stiffnessDamping);
    material.m_youngModulus = m_young.value_or(material.m_youngModulus);
    material.m_poissonRatio = m_poisson.value_or(material.m_poissonRatio);
    material.m_density = m_density.value_or(material.m_density);
    material.m_massDamping = m_massDamping.value_or(material.m_massDamping);
    if (!m_loss.empty()) setLossFactor(material, m_loss[0], m_loss[1]);
    material.m_meanDilatation = m_meanDilatation == "on"    ? MeanDilatation::on
                                : m_meanDilatation == "off" ? MeanDilatation::off
                                                            : MeanDilatation::automatic;
    material.m_bending = m_bending == "plain"      ? Bending::plain
                         : m_bending == "accurate" ? Bending::accurate
                                                   : Bending::automatic;
    material.m_law = law().value_or(material.m_law);
    return material;
}

std::optional<ElasticLaw> MaterialOptions::law() const
{
    if (m_law.empty()) return {};
    return m_law == "hooke" ? ElasticLaw::hooke : ElasticLaw::neoHooke;
}

}  // namespace bullet_fem
