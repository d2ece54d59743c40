// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/assumed_strain.h"
#include "bullet_fem/fem/mesh/element_materials.h"
#include "bullet_fem/fem/mesh/element_patches.h"
#include "bullet_fem/fem/mesh/material.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Rest data of one element. The shape gradients g_1, g_2, g_3 [1/m] are the rows of D_m^-1, g_0 = -(g_1 + g_2 + g_3);
/// the deformation gradient is F = sum over a of (x_a - x_0) g_a^T.
struct RestElement
{
    Mat3 m_DmInverse;       ///< inverse of [X1-X0, X2-X0, X3-X0] [1/m]
    double m_lambdaVolume;  ///< lambda V_e times the filled fraction [J]
    double m_muVolume;      ///< mu V_e times the filled fraction [J]
    double m_volume;        ///< V_e times the filled fraction [m3]
};

/// Lumped node masses of one density [kg/m3]: sum of rho V_e filled_e / 4 [kg], one per node. `filled`: one fraction
/// per element, or empty if all are 1. Allocates.
BULLETFEM_API std::vector<double> lumpedMasses(const TetMesh& mesh, const std::vector<double>& filled, double density);
/// Lumped node masses of the materials' densities times `massScale` [-]: sum of massScale rho_e V_e filled_e / 4 [kg],
/// one per node. `filled`: one fraction per element, or empty if all are 1. Allocates.
BULLETFEM_API std::vector<double> lumpedMasses(const TetMesh& mesh, const std::vector<double>& filled,
                                               const ElementMaterials& materials, double massScale);

/// A mesh with its materials, ready to be stepped. Constant once built; shared by all bodies of this shape.
struct BULLETFEM_API RestShape
{
    /// Builds the rest data. `filled`: one fraction per element in (0, 1], the factor on its mass and stiffness; empty
    /// if all are 1. `massScale`: factor on all masses, > 0. Throws std::invalid_argument on bad materials
    /// (ElementMaterials::validate), fractions or scale. Allocates.
    RestShape(TetMesh mesh, ElementMaterials materials, const std::vector<double>& filled = {}, double massScale = 1);

    /// V_e over the volume of its patch, both times the filled fractions [-]; 1 without patches.
    double shareOfPatch(int e) const;

    /// Size of the region whose strain the law of element e is evaluated at [m]: cube root of the volume of the
    /// element, with accurate bending of its patch.
    double lawSizeOf(int e) const;

    /// The materials with the bending that the elements have: never Bending::automatic. Allocates.
    ElementMaterials chosenMaterials() const { return m_materials.withBending(m_isThin); }

    /// Material of element e.
    const Material& materialOf(int e) const { return m_materials.of(e); }

    /// True if any region is orthotropic: stresses are those of stiffnessOf().
    bool isOrthotropic() const { return !m_regionStiffness.empty(); }
    /// Stiffness matrix C of element e in the axes of the rest shape; requires isOrthotropic().
    const ElasticMatrix& stiffnessOf(int e) const { return m_regionStiffness[m_materials.regionOf(e)]; }

    /// The mesh.
    TetMesh m_mesh;
    /// The materials of its elements.
    ElementMaterials m_materials;
    bool m_isThin = false;  ///< isThinSomewhere(m_mesh), if a material has Bending::automatic
    Material m_material;    ///< material of the first region; its damping coefficients hold for all regions
    /// Rest data of every element.
    std::vector<RestElement> m_elements;
    ElementPatches m_patches;       ///< patches of mean dilatation; empty if every element has its own volume change
    AssumedStrain m_assumedStrain;  ///< of patches; empty without accurate bending
    /// C of every region, those of Hooke's law included; empty if no region is orthotropic.
    std::vector<ElasticMatrix> m_regionStiffness;
    std::vector<double> m_patchVolume;  ///< volume of each patch times the filled fractions [m3]
    std::vector<double> m_lumpedMass;   ///< per node, sum of rho V_e / 4 [kg]; with 1 kg/m3 where the density is 0
};

}  // namespace bullet_fem
