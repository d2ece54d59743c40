// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <map>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/material.h"

namespace bullet_fem
{

/// A region of a mesh: its elements have one material.
struct MaterialRegion
{
    int m_label = 0;      ///< what a file or a program calls it
    Material m_material;  ///< of its elements

    /// The same label and values.
    friend bool operator==(const MaterialRegion& a, const MaterialRegion& b)
    {
        return a.m_label == b.m_label && a.m_material == b.m_material;
    }
    /// Not so.
    friend bool operator!=(const MaterialRegion& a, const MaterialRegion& b) { return !(a == b); }
};

/// What the elements of a mesh are made of: one material, or those of regions, with one index an element. All values
/// are a region's own, but both dampings are the body's, and a density of 0 (which keeps the body's own masses) is that
/// of all regions or of none.
struct BULLETFEM_API ElementMaterials
{
    /// All elements have this one.
    ElementMaterials(const Material& material = Material()) : m_regions{{0, material}} {}  // NOLINT: a material is one
    /// `regionOf`: per element, into `regions`; empty if there is one region alone.
    ElementMaterials(std::vector<MaterialRegion> regions, std::vector<int> regionOf);

    /// Regions as a mesh has them: per element the label, and a material for every label that occurs. Materials of
    /// other labels are left out. Throws std::invalid_argument, naming the label, its first element and the labels that
    /// are given, where a label has no material.
    static ElementMaterials ofLabels(const std::vector<int>& labels, const std::map<int, Material>& materials);
    /// One material an element; those that are equal make a region, which is called after its first element.
    static ElementMaterials ofElements(const std::vector<Material>& perElement);

    /// Throws std::invalid_argument, naming region and value, on materials that are not valid or do not go together,
    /// on another number of elements, and on indices out of range.
    void validate(int elementCount) const;

    /// Whether there is one material alone.
    bool isUniform() const { return m_regionOf.empty(); }
    /// Of an element, which must be of the mesh.
    const Material& of(int e) const { return m_regions[regionOf(e)].m_material; }
    /// Its region, into m_regions.
    std::size_t regionOf(int e) const
    {
        return isUniform() ? 0 : static_cast<std::size_t>(m_regionOf[static_cast<std::size_t>(e)]);
    }
    /// The material of the first region: it has the dampings of all.
    const Material& first() const { return m_regions.front().m_material; }

    static constexpr int kAlone = -1;  ///< in patchGroups(): in no patch with others
    /// Which elements may be in one patch of mean dilatation: those of the same number. Regions of equal materials have
    /// the same number. Empty if that is all of them.
    std::vector<int> patchGroups() const;
    /// Whether any region shares volume changes.
    bool usesMeanDilatation() const;
    /// Whether any region has a law that is not linear; regions that share volume changes are refused beside it.
    bool isNonlinear() const;
    /// Whether any region is orthotropic; regions that share volume changes or are Neo-Hookean are refused beside it.
    bool isOrthotropic() const;
    /// Whether any region bends accurately.
    bool bendsAccurately() const;
    /// Whether any region yields.
    bool yields() const;
    /// The most relaxation terms of a region.
    int relaxationTerms() const;

    /// The same regions of the same elements.
    friend bool operator==(const ElementMaterials& a, const ElementMaterials& b)
    {
        return a.m_regions == b.m_regions && a.m_regionOf == b.m_regionOf;
    }
    /// Not so.
    friend bool operator!=(const ElementMaterials& a, const ElementMaterials& b) { return !(a == b); }

    std::vector<MaterialRegion> m_regions;  ///< at least one
    std::vector<int> m_regionOf;            ///< per element, into m_regions; empty: all are in the first
};

}  // namespace bullet_fem
