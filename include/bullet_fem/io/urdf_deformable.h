// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/material.h"

namespace bullet_fem
{

/// The `<deformable>` block of a URDF file, as pybullet reads it. Missing values are pybullet's defaults.
struct UrdfDeformable
{
    /// Name of the block; may be empty.
    std::string m_name;
    double m_mass = 1;                ///< mass of the body [kg], > 0
    double m_collisionMargin = 0.02;  ///< [m], >= 0
    double m_friction = 1;            ///< [-], >= 0
    double m_gravityFactor = 1;       ///< [-], finite
    bool m_elastic = false;           ///< `<corotated>` or `<neohookean>` is present; otherwise there are no moduli
    LameModuli m_moduli;              ///< moduli [Pa], mu > 0; the sum of both laws, as pybullet adds their forces
    double m_damping = 0;             ///< stiffness damping, Rayleigh's beta [s], >= 0
    std::string m_meshPath;           ///< file of the tetrahedra, from `<collision>`, or from `<visual>` without one
    std::string m_visualPath;         ///< file of the surface to draw; empty if it is m_meshPath
};

/// Reads the first `<deformable>` of a URDF file. Mesh files are searched in its folder, then in the four folders
/// above; the prefixes "package://" and "model://" are removed. Springs, bending and repulsion stiffness do not apply
/// to finite elements and are ignored. Throws std::runtime_error naming file, line, the contents found and expected: a
/// file that is missing, unreadable or not XML; no `<deformable>`; an element or attribute missing; a number out of
/// range; a mesh file that is not found. Allocates.
BULLETFEM_API UrdfDeformable readUrdfDeformable(const std::string& path);

}  // namespace bullet_fem
