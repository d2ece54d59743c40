// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/edge_domains.h"
#include "bullet_fem/fem/mesh/element_materials.h"
#include "bullet_fem/fem/mesh/element_patches.h"
#include "bullet_fem/fem/mesh/material.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// What one element knows of its rest shape. The shape gradients g_1, g_2, g_3 [1/m] are the rows of D_m^-1,
/// g_0 = -(g_1 + g_2 + g_3); the deformation gradient is F = sum over a of (x_a - x_0) g_a^T.
struct RestElement
{
    Mat3 m_DmInverse;       ///< inverse of [X1-X0, X2-X0, X3-X0] [1/m]
    double m_lambdaVolume;  ///< lambda V_e times the filled fraction [J]
    double m_muVolume;      ///< mu V_e times the filled fraction [J]
    double m_volume;        ///< V_e times the filled fraction [m3]
};

/// Masses that a density gives the nodes: sum of rho V_e filled_e / 4 [kg]. `filled` is one fraction an element, or
/// empty for all 1.
BULLETFEM_API std::vector<double> lumpedMasses(const TetMesh& mesh, const std::vector<double>& filled, double density);
/// The same of the materials' densities, times a factor on all masses.
BULLETFEM_API std::vector<double> lumpedMasses(const TetMesh& mesh, const std::vector<double>& filled,
                                               const ElementMaterials& materials, double massScale);

/// A mesh of one or more materials, ready to be stepped: built once, then const; shared by all bodies that are made of
/// it.
struct BULLETFEM_API RestShape
{
    /// `filled`: per element, the fraction in (0, 1] that its mass and stiffness are scaled by; empty for all 1.
    /// `massScale`: factor on all masses, > 0. Throws std::invalid_argument on bad materials (see
    /// ElementMaterials::validate), fractions or scale.
    RestShape(TetMesh mesh, ElementMaterials materials, const std::vector<double>& filled = {}, double massScale = 1);

    /// V_e over the volume of its patch, filled fractions in both [-]; 1 where there are no patches.
    double shareOfPatch(int e) const;

    /// Of an element.
    const Material& materialOf(int e) const { return m_materials.of(e); }

    /// Whether stresses are those of stiffnessOf().
    bool isOrthotropic() const { return !m_regionStiffness.empty(); }
    /// C of an element, in the axes of the rest shape; of a shape that isOrthotropic().
    const ElasticMatrix& stiffnessOf(int e) const { return m_regionStiffness[m_materials.regionOf(e)]; }

    /// The mesh.
    TetMesh m_mesh;
    /// What its elements are made of.
    ElementMaterials m_materials;
    Material m_material;  ///< of the first region: the only one of a uniform body, and dampings are those of all
    /// What steps need of every element; the type is not public.
    std::vector<RestElement> m_elements;
    ElementPatches m_patches;   ///< of elements that share their volume change; none where every one has its own
    EdgeDomains m_edgeDomains;  ///< over which strains are averaged; none where no material bends accurately
    /// C of every region, of those with Hooke's law, too; none where no region is orthotropic.
    std::vector<ElasticMatrix> m_regionStiffness;
    std::vector<double> m_patchVolume;  ///< of every patch, filled fractions in it [m3]
    std::vector<double> m_lumpedMass;   ///< per node, sum of rho V_e / 4 [kg]; of 1 kg/m3 where the density is 0
};

}  // namespace bullet_fem
