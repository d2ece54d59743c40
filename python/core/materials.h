// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <map>
#include <vector>

#include "LinearMath/btMatrix3x3.h"
#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/fem/mesh/material.h"

namespace bullet_fem::python
{

/// Materials of a body's elements: one, whose values arrays may replace, or one for each label.
struct ElementMaterials
{
    Material m_base;
    std::vector<double> m_young, m_poisson, m_density;  ///< per element, or empty: m_base's
    std::vector<Vec3> m_along, m_across;                ///< per element, or empty: m_base's
    std::vector<int> m_labels;                          ///< per element; empty: m_base
    std::map<int, Material> m_ofLabel;

    bool isOne() const;
    /// The materials of `count` elements, with axes turned from those of the mesh. Throws std::invalid_argument on
    /// another number of elements or a label without material.
    std::vector<btFemMaterial> expand(int count, const btMatrix3x3& turn) const;
};

}  // namespace bullet_fem::python
