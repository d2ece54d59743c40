// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/laws/law_table.h"

namespace bullet_fem
{

/// Version of the format. A reader accepts only supported versions: files are recreated in seconds.
constexpr std::uint32_t kBakedVersion = 2;

/// Version for bodies with several regions, so that older readers refuse them.
constexpr std::uint32_t kBakedRegionsVersion = 3;
/// Version for bodies with a region whose law has constants of its own.
constexpr std::uint32_t kBakedConstantsVersion = 4;

/// Alignment of sections and panels in a file [B].
constexpr std::size_t kBakedAlignment = 64;

/// Flag in m_meanDilatation of a Neo-Hookean material; older readers refuse the value.
constexpr std::uint32_t kBakedNeoHooke = 4;

/// Plasticity of a material; all 0: the defaults, without yield.
struct BakedPlasticity
{
    float m_yieldStress, m_hardeningModulus, m_creep, m_maxStrain;
};

/// The header of a file, byte by byte. Unused bytes are 0.
struct BakedHeader
{
    std::array<char, 8> m_magic;
    std::uint32_t m_byteOrder, m_version;
    std::uint64_t m_fileBytes, m_headerChecksum, m_bodyChecksum;  // m_headerChecksum is computed with itself 0
    std::uint64_t m_panelFloats, m_entries, m_fullBytes;
    std::uint32_t m_nodes, m_tets, m_filled, m_embedded, m_triangles;
    std::uint32_t m_freeNodes, m_supernodes, m_rows, m_restBlocks;
    std::uint32_t m_lowMemory, m_singlePrecision, m_meanDilatation;
    double m_step, m_massScale;
    double m_youngModulus, m_poissonRatio, m_density, m_massDamping, m_stiffnessDamping;
    std::array<char, 48> m_backend;  // padded with zeros
    std::array<char, 16> m_ordering;
    std::uint32_t m_surfaceCollides;
    BakedPlasticity m_plasticity;
    std::uint32_t m_regions;  // 0: one material, in the fields above
};
static_assert(sizeof(BakedHeader) == 256 && sizeof(BakedHeader) % kBakedAlignment == 0);

/// Flag in m_meanDilatation of a material with accurate bending.
constexpr std::uint32_t kBakedAccurateBending = 8;
/// Flag in m_meanDilatation of a material with Bending::automatic.
constexpr std::uint32_t kBakedAutomaticBending = 32;
/// Flag in m_meanDilatation of an orthotropic material.
constexpr std::uint32_t kBakedOrthotropic = 16;
/// Bits of m_meanDilatation with the number of a law beyond orthotropic.
constexpr std::uint32_t kBakedLawBits = 0xff00, kBakedLawShift = 8;
constexpr std::uint32_t kBakedFlags =
    kBakedNeoHooke | kBakedAccurateBending | kBakedAutomaticBending | kBakedOrthotropic | kBakedLawBits;

/// Mean dilatation, bending and law of a material in one number.
inline std::uint32_t averagingOf(const Material& material)
{
    return static_cast<std::uint32_t>(material.m_meanDilatation) |
           (material.m_bending == Bending::accurate ? kBakedAccurateBending : 0) |
           (material.m_bending == Bending::automatic ? kBakedAutomaticBending : 0) |
           (material.m_law == ElasticLaw::neoHooke ? kBakedNeoHooke : 0) |
           (material.isOrthotropic() ? kBakedOrthotropic : 0) |
           (material.m_law > ElasticLaw::orthotropic ? static_cast<std::uint32_t>(material.m_law) << kBakedLawShift
                                                     : 0);
}

/// True if the file has BakedConstants of the material.
inline bool hasBakedConstants(const Material& material)
{
    return material.isOrthotropic() || !constantsOf(material.m_law).empty();
}

/// A supernode in the file; columns and rows are stored consecutively.
struct BakedSupernode
{
    std::int32_t m_columns, m_rows, m_parent;
};

/// A region in the file.
struct BakedRegion
{
    std::int32_t m_label;
    std::uint32_t m_meanDilatation;
    double m_youngModulus, m_poissonRatio, m_density, m_massDamping, m_stiffnessDamping;
    BakedPlasticity m_plasticity;
};
static_assert(sizeof(BakedRegion) == 64);

/// Constants and directions of a region in the file, as in Orthotropic; of other laws, Material::m_lawConstants in
/// m_young and m_poisson.
struct BakedConstants
{
    std::array<double, 3> m_young, m_poisson, m_shear;
    Vec3 m_along, m_across;
};
static_assert(sizeof(BakedConstants) == 120);

/// All arrays after the panels.
struct BakedArrays
{
    std::vector<Vec3> m_positions;
    std::vector<double> m_inverseMass, m_filled, m_diagonal;
    std::vector<std::array<double, 4>> m_weights;
    std::vector<float> m_restValues;
    std::vector<Tet> m_tets;
    std::vector<Triangle> m_triangles;
    std::vector<int> m_vertexTet, m_order, m_row, m_restRowStart, m_restColumn;
    std::vector<BakedSupernode> m_supernodes;
    std::vector<unsigned char> m_sides, m_fixed;
    std::vector<BakedRegion> m_regions;  // m_regions, m_regionOf: empty for a body of one material
    std::vector<std::int32_t> m_regionOf;
    std::vector<BakedConstants> m_constants;  // one per region; empty if no law has constants
};

/// Calls section(array, length) for each array, in the order of the file.
template <class Arrays, class Section>
void forEachSection(Arrays& a, const BakedHeader& h, const Section& section)
{
    const std::size_t restRows = h.m_lowMemory ? std::size_t(h.m_freeNodes) + 1 : 0;
    section(a.m_positions, h.m_nodes);
    section(a.m_inverseMass, h.m_nodes);
    section(a.m_diagonal, h.m_nodes);
    section(a.m_filled, h.m_filled);
    section(a.m_weights, h.m_embedded);
    section(a.m_restValues, 9 * std::size_t(h.m_restBlocks));
    section(a.m_tets, h.m_tets);
    section(a.m_triangles, h.m_triangles);
    section(a.m_vertexTet, h.m_embedded);
    section(a.m_order, h.m_freeNodes);
    section(a.m_supernodes, h.m_supernodes);
    section(a.m_row, h.m_rows);
    section(a.m_restRowStart, restRows);
    section(a.m_restColumn, h.m_restBlocks);
    section(a.m_sides, h.m_tets);
    section(a.m_fixed, h.m_nodes);
    section(a.m_regions, h.m_regions);
    section(a.m_regionOf, h.m_regions > 0 ? h.m_tets : 0);
    section(a.m_constants, h.m_version != kBakedConstantsVersion ? 0 : h.m_regions > 0 ? h.m_regions : 1);
}

/// Offset of the next section after so many bytes.
constexpr std::uint64_t alignedBytes(std::uint64_t bytes)
{
    return (bytes + kBakedAlignment - 1) / kBakedAlignment * kBakedAlignment;
}

/// Size of the file that belongs to this header [B].
std::uint64_t bakedFileBytes(const BakedHeader& header);

/// 64-bit XXH3 checksum.
std::uint64_t checksumOf(const void* data, std::size_t size);

/// Completes a header whose counts and values are set: magic, byte order, version (unless it is
/// kBakedConstantsVersion), file size and checksums; `body` is all that follows it.
void sealHeader(BakedHeader& header, const unsigned char* body, std::size_t bodyBytes);

/// Reads the header of a file of `fileBytes`, whose first `size` bytes are given. Throws std::invalid_argument with
/// reason and remedy; the returned header has counts consistent with the file's length, and values in their ranges.
BakedHeader openHeader(const unsigned char* data, std::size_t size, std::uint64_t fileBytes);

/// The materials in the arrays and header of a file, unchecked.
ElementMaterials materialsOf(const BakedHeader& header, const BakedArrays& arrays);

/// The information of a header, without the constants of orthotropic materials.
BakedFileInfo infoOf(const BakedHeader& header);

/// Offset of the first region's constants in a file of version kBakedConstantsVersion, whose last section has the
/// constants of all regions.
std::uint64_t constantsOffset(const BakedHeader& header);
/// The material with these constants. Throws std::invalid_argument if it is invalid.
Material withConstants(Material material, const BakedConstants& constants);

}  // namespace bullet_fem
