// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/symmetric.h"
#include "bullet_fem/fem/mesh/element_materials.h"
#include "bullet_fem/fem/mesh/element_patches.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Assumed strains of accurate bending [Simo & Hughes 1986; Krysl 2016]. The law of an element is evaluated at
///
///     eps~_e = eps_p + H_p (eps_e - eps_p),    eps_p = sum of V_e eps_e / sum of V_e over its patch p
///
/// Strains have one frame a patch: eps_e = sym(R_p^T F_e) - I with the polar rotation R_p of the patch's mean F. Then
/// eps_p is the stretch of this mean, and its stress does no work in the second order on strains that differ from it.
/// In frames of their own, elements of patches that are pulled by 10 % (cells four times as long as thick) to a
/// multiple of their length (cubes) have no stable equilibrium: tension outweighs the reduced stiffness.
///
/// H_p is symmetric and takes the deviator times sqrt(s). In the principal axes of the patch it also multiplies the
/// shear strain of axes i, j by the ratio of the patch's extents along them, the smaller over the larger: bending of
/// flat cells causes parasitic shear in proportion to the inverse ratio. H_p is the deviator alone in materials without
/// accurate bending. Constant once built.
struct BULLETFEM_API AssumedStrain
{
    /// s [-]: share of the energy of strains that differ from the patch's mean. Cantilevers of two cells of six
    /// elements across have 1.00 of Timoshenko's deflection with it, 1.02 with 0.3 and 0.98 with 0.36; of five
    /// elements 1.04, 1.06 and 1.02.
    static constexpr double kShare = 0.325;
    /// s [-] of patches of at most four elements, the octahedra of body-centred lattices: one cell across has .88 of
    /// Timoshenko's deflection with it, and .82 with kShare.
    static constexpr double kOctahedronShare = 0.2;
    /// s / (1 + nu) [-] of a patch without inner nodes, as in bodies one cell across: their stiffness in bending, 2 mu
    /// (1 + nu), is all of this energy. Cantilevers have .92 (six elements a cell) and 1.11 (five) of their deflection.
    static constexpr double kThinShare = 0.346;
    static constexpr int kEntries = 21;  ///< entries of the upper triangle of a 6x6 matrix

    AssumedStrain() = default;
    /// Builds H_p of every patch. `volume`: one volume per element [m3], > 0. Allocates.
    AssumedStrain(const TetMesh& mesh, const ElementMaterials& materials, const ElementPatches& patches,
                  const std::vector<double>& volume);

    /// True if elements keep their own strains.
    bool empty() const { return m_filter.empty(); }
    /// H_p^2 in the form of m_filter.
    std::array<double, kEntries> square(int patch) const;
    /// H_p a of a strain or stress.
    SymmetricTensor filtered(int patch, const SymmetricTensor& a) const;
    /// Replaces the strains of a patch's elements, `count` of them, by the assumed ones. `share`: V_e over the patch's
    /// volume [-].
    void assume(int patch, int count, const double* share, SymmetricTensor* strain) const;

    /// H_p of every patch as a matrix from strains with doubled shears to tensor components, in the order xx, yy, zz,
    /// yz, xz, xy; the upper triangle row by row.
    std::vector<std::array<double, kEntries>> m_filter;
};

}  // namespace bullet_fem
