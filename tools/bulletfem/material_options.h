// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "bullet_fem/fem/mesh/material.h"

namespace bullet_fem
{

/// A material from the command line: a preset, and values in its place.
class MaterialOptions
{
public:
    void add(CLI::App& command);
    Material material() const;

private:
    std::string m_preset;
    std::optional<double> m_young, m_poisson, m_density, m_massDamping, m_stiffnessDamping;
};

}  // namespace bullet_fem
