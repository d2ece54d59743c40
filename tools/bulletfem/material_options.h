// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bullet_fem/fem/mesh/material.h"

namespace bullet_fem
{

/// A material on the command line: a preset and values that replace those of the preset.
class MaterialOptions
{
public:
    void add(CLI::App& command);
    Material material() const;
    /// Materials of regions by label; values that are not given are those of material(). Throws std::runtime_error on a
    /// text that is no material.
    std::map<int, Material> regions() const;

private:
    std::optional<ElasticLaw> law() const;  // replaces the preset's law

    Material base() const;  // preset, or an elastomer of the given hardness

    std::string m_preset, m_meanDilatation, m_bending, m_law;
    std::vector<std::string> m_regions;
    std::optional<double> m_shoreA, m_shoreD, m_young, m_poisson, m_density, m_massDamping, m_stiffnessDamping;
    std::vector<double> m_loss;  // loss factor and frequency; empty if not given
};

}  // namespace bullet_fem
