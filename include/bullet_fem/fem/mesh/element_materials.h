// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <map>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/material.h"

namespace bullet_fem
{

/// A region of a mesh: a set of elements with one material.
struct MaterialRegion
{
    int m_label = 0;      ///< name given by a file or a program
    Material m_material;  ///< material of the region's elements

    /// True if label and material are equal.
    friend bool operator==(const MaterialRegion& a, const MaterialRegion& b)
    {
        return a.m_label == b.m_label && a.m_material == b.m_material;
    }
    /// True if label or material differs.
    friend bool operator!=(const MaterialRegion& a, const MaterialRegion& b) { return !(a == b); }
};

/// The materials of a mesh's elements: one for all, or one per region with a region index per element. Each region has
/// its own values, except the two Rayleigh dampings, which must be equal in all regions, and a density of 0 (which
/// keeps the body's own masses), which all regions or none must have.
struct BULLETFEM_API ElementMaterials
{
    /// One material for all elements.
    ElementMaterials(const Material& material = Material()) : m_regions{{0, material}} {}  // NOLINT: implicit by design
    /// Materials by region. `regionOf`: one index into `regions` an element; empty if there is one region.
    ElementMaterials(std::vector<MaterialRegion> regions, std::vector<int> regionOf);

    /// Materials by label: `labels` has one label per element, `materials` one material for every label that occurs;
    /// other materials are ignored. Throws std::invalid_argument, naming the label, its first element and the labels
    /// given, if a label has no material. Allocates.
    static ElementMaterials ofLabels(const std::vector<int>& labels, const std::map<int, Material>& materials);
    /// One material per element. Elements of equal materials form a region, labelled by its first element. Allocates.
    static ElementMaterials ofElements(const std::vector<Material>& perElement);

    /// Throws std::invalid_argument, naming region and value, on invalid or incompatible materials, on an element count
    /// other than `elementCount`, and on indices out of range.
    void validate(int elementCount) const;

    /// True if there is a single material.
    bool isUniform() const { return m_regionOf.empty(); }
    /// Material of element e, in [0, element count).
    const Material& of(int e) const { return m_regions[regionOf(e)].m_material; }
    /// Region of element e, an index into m_regions.
    std::size_t regionOf(int e) const
    {
        return isUniform() ? 0 : static_cast<std::size_t>(m_regionOf[static_cast<std::size_t>(e)]);
    }
    /// Material of the first region; its damping coefficients hold for all regions.
    const Material& first() const { return m_regions.front().m_material; }

    static constexpr int kAlone = -1;  ///< value in patchGroups() of elements that share no patch
    /// Patch groups for mean dilatation: only elements with equal numbers may share a patch. Regions of equal materials
    /// have equal numbers. One number per element; empty if all elements form one group. Allocates.
    std::vector<int> patchGroups() const;
    /// True if any region uses mean dilatation; Bending::automatic counts as plain.
    bool usesMeanDilatation() const;
    /// True if any region's law is evaluated in every step; validate() refuses orthotropic regions
    /// beside it.
    bool isNonlinear() const;
    /// True if any region is orthotropic; validate() refuses laws that vary in the other regions then, and mean
    /// dilatation if no region has accurate bending.
    bool isOrthotropic() const;
    /// True if any region has accurate bending; Bending::automatic counts as plain.
    bool bendsAccurately() const;
    /// True if any region has Bending::automatic.
    bool choosesBending() const;
    /// These materials with Bending::automatic replaced: by accurate in a thin body unless mean dilatation is off, else
    /// by plain. Allocates.
    ElementMaterials withBending(bool isThin) const;
    /// True if any region has a yield stress.
    bool yields() const;
    /// Maximum number of relaxation terms over the regions.
    int relaxationTerms() const;
    /// Maximum number of an element's history variables over the laws of the regions.
    int historyCount() const;

    /// True if regions and region indices are equal.
    friend bool operator==(const ElementMaterials& a, const ElementMaterials& b)
    {
        return a.m_regions == b.m_regions && a.m_regionOf == b.m_regionOf;
    }
    /// True if regions or region indices differ.
    friend bool operator!=(const ElementMaterials& a, const ElementMaterials& b) { return !(a == b); }

    std::vector<MaterialRegion> m_regions;  ///< at least one region
    std::vector<int> m_regionOf;            ///< region index of each element; empty: all elements are in the first
};

}  // namespace bullet_fem
