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

/// A material from the command line: a preset, and values in its place.
class MaterialOptions
{
public:
    void add(CLI::App& command);
    Material material() const;
    /// Those of regions, by label; what is not given is material()'s. Throws std::runtime_error on a text that is none.
    std::map<int, Material> regions() const;

private:
    std::optional<ElasticLaw> law() const;  // that is in place of the preset's

    std::string m_preset, m_meanDilatation, m_law;
    bool m_accurateBending = false;
    std::vector<std::string> m_regions;
    std::optional<double> m_young, m_poisson, m_density, m_massDamping, m_stiffnessDamping;
};

}  // namespace bullet_fem
