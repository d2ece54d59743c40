// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/material.h"

namespace bullet_fem
{

/// The `<deformable>` block of a URDF file, as pybullet reads it. What the file does not give is as in pybullet.
struct UrdfDeformable
{
    /// Of the block; may be empty.
    std::string m_name;
    double m_mass = 1;                ///< of the whole body [kg], > 0
    double m_collisionMargin = 0.02;  ///< [m], >= 0
    double m_friction = 1;            ///< [-], >= 0
    double m_gravityFactor = 1;       ///< [-], finite
    bool m_elastic = false;           ///< `<corotated>` or `<neohookean>` is there; else there are no moduli
    LameModuli m_moduli;              ///< [Pa], mu > 0: of both laws added, as pybullet's forces do
    double m_damping = 0;             ///< of stiffness, Rayleigh's beta [s], >= 0
    std::string m_meshPath;           ///< file of tetrahedra: that of `<collision>`, or of `<visual>` without one
    std::string m_visualPath;         ///< file of the surface to draw; empty if it is the same
};

/// Reads the first `<deformable>` of a URDF file. Mesh files are looked for beside it, then in the four folders above;
/// "package://" and "model://" are taken off. Springs, bending and repulsion stiffness mean nothing to elements and
/// are ignored. Throws std::runtime_error naming file, line, what was found and what was expected: a file that is
/// missing, unreadable or not XML; no `<deformable>`; an element or attribute missing; a number out of range; a mesh
/// file that is not found.
BULLETFEM_API UrdfDeformable readUrdfDeformable(const std::string& path);

}  // namespace bullet_fem
