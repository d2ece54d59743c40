// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/baked/baked_header.h"

#define XXH_INLINE_ALL  // header-only, nothing to link
#include <xxhash.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstring>
#include <string>

#include "fem/common/bounds.h"
#include "fem/common/message.h"
#include "fem/laws/law.h"

namespace bullet_fem
{
namespace
{

constexpr std::array<char, 8> kMagic = {'B', 'F', 'E', 'M', 'B', 'O', 'D', 'Y'};
constexpr std::uint32_t kByteOrder = 0x01020304, kOtherByteOrder = 0x04030201;
constexpr std::uint32_t kMaxCount = INT_MAX / 12;  // as in TetMesh
constexpr std::uint64_t kMaxEntries = std::uint64_t(1) << 50;

constexpr const char* kDamaged = "; copy or bake it anew";

std::uint64_t headerChecksum(BakedHeader header)
{
    header.m_headerChecksum = 0;
    return checksumOf(&header, sizeof header);
}

Material yielding(Material material, const BakedPlasticity& p)
{
    if (p.m_yieldStress == 0 && p.m_hardeningModulus == 0 && p.m_creep == 0 && p.m_maxStrain == 0) return material;
    material.m_yieldStress = static_cast<double>(p.m_yieldStress);
    material.m_hardeningModulus = static_cast<double>(p.m_hardeningModulus);
    material.m_plasticCreep = static_cast<double>(p.m_creep);
    material.m_mostPlasticStrain = static_cast<double>(p.m_maxStrain);
    return material;
}

// The material of a header or of a region.
template <class Numbers>
Material materialOf(const Numbers& h)
{
    Material material;
    material.m_youngModulus = h.m_youngModulus;
    material.m_poissonRatio = h.m_poissonRatio;
    material.m_density = h.m_density;
    material.m_massDamping = h.m_massDamping;
    material.m_stiffnessDamping = h.m_stiffnessDamping;
    material.m_meanDilatation = static_cast<MeanDilatation>(h.m_meanDilatation & ~kBakedFlags);
    if (h.m_meanDilatation & kBakedNeoHooke) material.m_law = ElasticLaw::neoHooke;
    if (h.m_meanDilatation & kBakedOrthotropic) material.m_law = ElasticLaw::orthotropic;
    if (h.m_meanDilatation & kBakedLawBits)
    {
        const std::uint32_t law = (h.m_meanDilatation & kBakedLawBits) >> kBakedLawShift;
        if (law >= allLaws().size()) reject("its law is ", law, ", not below ", allLaws().size(), kDamaged);
        material.m_law = static_cast<ElasticLaw>(law);
    }
    material.m_bending = h.m_meanDilatation & kBakedAccurateBending    ? Bending::accurate
                         : h.m_meanDilatation & kBakedAutomaticBending ? Bending::automatic
                                                                       : Bending::plain;
    return yielding(material, h.m_plasticity);
}

// True for printable text, padded with zeros.
template <std::size_t size>
bool isText(const std::array<char, size>& text)
{
    const auto end = std::find(text.begin(), text.end(), '\0');
    return end != text.end() && std::all_of(text.begin(), end, [](char c) { return c >= ' ' && c <= '~'; }) &&
           std::all_of(end, text.end(), [](char c) { return c == '\0'; });
}

void checkVersion(const BakedHeader& header)
{
    if (header.m_magic != kMagic) reject("it is not a baked body; give a .bfem file");
    if (header.m_byteOrder == kOtherByteOrder)
        reject("it was baked on a machine of the other byte order; bake it on one of this machine's");
    if (header.m_byteOrder != kByteOrder) reject("its byte order mark is damaged", kDamaged);
    if (header.m_version < kBakedVersion)
        reject("its format has the older version ", header.m_version, ", and this program reads versions ",
               kBakedVersion, " to ", kBakedConstantsVersion, " alone; bake it anew");
    if (header.m_version > kBakedConstantsVersion)
        reject("its format has the newer version ", header.m_version, ", and this program reads versions ",
               kBakedVersion, " to ", kBakedConstantsVersion,
               " alone; build the program with a newer BulletFEM, or bake it with this one");
    if (header.m_headerChecksum != headerChecksum(header)) reject("its header is damaged", kDamaged);
}

void checkCounts(const BakedHeader& h)
{
    for (std::uint32_t count : {h.m_nodes, h.m_tets, h.m_filled, h.m_embedded, h.m_triangles, h.m_freeNodes,
                                h.m_supernodes, h.m_rows, h.m_restBlocks})
        if (count > kMaxCount) reject("a count of its header is ", count, ", more than ", kMaxCount, kDamaged);
    if (h.m_nodes < 4 || h.m_tets < 1) reject("it has ", h.m_nodes, " nodes and ", h.m_tets, " elements", kDamaged);
    if (h.m_filled != 0 && h.m_filled != h.m_tets)
        reject("it has ", h.m_filled, " filled fractions for ", h.m_tets, " elements", kDamaged);
    if (h.m_freeNodes > h.m_nodes || h.m_supernodes > h.m_freeNodes)
        reject("it has ", h.m_freeNodes, " free nodes of ", h.m_nodes, ", and ", h.m_supernodes, " supernodes",
               kDamaged);
    if (h.m_panelFloats > h.m_fileBytes / sizeof(float) || h.m_entries > kMaxEntries || h.m_fullBytes > kMaxEntries)
        reject("its factor has ", h.m_panelFloats, " floats of ", h.m_fullBytes, " bytes and ", h.m_entries, " entries",
               kDamaged);
    const bool asVersion =
        h.m_version == kBakedConstantsVersion || (h.m_regions > 0) == (h.m_version == kBakedRegionsVersion);
    if (h.m_regions > h.m_tets || !asVersion)
        reject("it has ", h.m_regions, " regions of ", h.m_tets, " elements in version ", h.m_version, kDamaged);
    if (h.m_surfaceCollides > (h.m_triangles > 0 ? 1 : 0))
        reject("its header says that a surface of ", h.m_triangles, " triangles collides", kDamaged);
    if (h.m_lowMemory > 1 || h.m_singlePrecision > 1 || (h.m_restBlocks > 0) != (h.m_lowMemory == 1))
        reject("its header tells no kind of factor", kDamaged);
}

void checkValues(const BakedHeader& h)
{
    if ((h.m_meanDilatation & ~kBakedFlags) > static_cast<std::uint32_t>(MeanDilatation::off))
        reject("its mean dilatation is ", h.m_meanDilatation, ", not in [0, 2]", kDamaged);
    Material material = materialOf(h);
    if (hasBakedConstants(material) && h.m_version != kBakedConstantsVersion)
        reject("its material is ", nameOf(material.m_law), " in version ", h.m_version, kDamaged);
    if (hasBakedConstants(material)) material.m_law = ElasticLaw::hooke;  // the law is checked with its constants
    material.validate();
    if (!isUsableStep(h.m_step)) reject("its step is ", h.m_step, " s, not in [1e-6, 1]", kDamaged);
    if (!(h.m_massScale > 0) || !std::isfinite(h.m_massScale))
        reject("its mass scale is ", h.m_massScale, ", not in (0, inf)", kDamaged);
    if (!isText(h.m_backend) || !isText(h.m_ordering)) reject("its header has values of no meaning", kDamaged);
}

}  // namespace

std::uint64_t checksumOf(const void* data, std::size_t size)
{
    return XXH3_64bits(data, size);
}

std::uint64_t bakedFileBytes(const BakedHeader& header)
{
    std::uint64_t bytes = alignedBytes(sizeof header + sizeof(float) * header.m_panelFloats);
    const BakedArrays none;
    forEachSection(none, header,
                   [&bytes](const auto& array, std::size_t count)
                   { bytes = alignedBytes(bytes + count * sizeof array[0]); });
    return bytes;
}

void sealHeader(BakedHeader& header, const unsigned char* body, std::size_t bodyBytes)
{
    header.m_magic = kMagic;
    header.m_byteOrder = kByteOrder;
    if (header.m_version != kBakedConstantsVersion)
        header.m_version = header.m_regions > 0 ? kBakedRegionsVersion : kBakedVersion;
    header.m_fileBytes = sizeof header + bodyBytes;
    header.m_bodyChecksum = checksumOf(body, bodyBytes);
    header.m_headerChecksum = headerChecksum(header);
}

BakedHeader openHeader(const unsigned char* data, std::size_t size, std::uint64_t fileBytes)
{
    BakedHeader header = {};
    if (size > 0) std::memcpy(&header, data, std::min(size, sizeof header));
    if (size < sizeof header && (size < kMagic.size() || header.m_magic == kMagic))
        reject("it has ", size, " bytes, and a baked body has ", sizeof header, " and more", kDamaged);
    checkVersion(header);
    if (header.m_fileBytes != fileBytes)
        reject("it has ", fileBytes, " bytes, and should have ", header.m_fileBytes, kDamaged);
    checkCounts(header);
    checkValues(header);
    if (bakedFileBytes(header) != fileBytes)
        reject("it has ", fileBytes, " bytes, and its sections take ", bakedFileBytes(header), kDamaged);
    return header;
}

ElementMaterials materialsOf(const BakedHeader& header, const BakedArrays& arrays)
{
    const auto with = [&arrays](Material material, std::size_t region)
    {
        if (!hasBakedConstants(material)) return material;
        if (region >= arrays.m_constants.size()) reject("region ", region, " has no constants of its law");
        return withConstants(material, arrays.m_constants[region]);
    };
    if (header.m_regions == 0) return with(materialOf(header), 0);
    std::vector<MaterialRegion> regions;
    for (const BakedRegion& r : arrays.m_regions) regions.push_back({r.m_label, with(materialOf(r), regions.size())});
    return {std::move(regions), arrays.m_regionOf};
}

Material withConstants(Material material, const BakedConstants& constants)
{
    if (material.isOrthotropic())
        material.m_orthotropic = {constants.m_young, constants.m_poisson, constants.m_shear, constants.m_along,
                                  constants.m_across};
    else
    {
        std::copy(constants.m_young.begin(), constants.m_young.end(), material.m_lawConstants.begin());
        std::copy(constants.m_poisson.begin(), constants.m_poisson.end(), material.m_lawConstants.begin() + 3);
    }
    material.validate();
    return material;
}

std::uint64_t constantsOffset(const BakedHeader& header)
{
    const std::uint64_t count = header.m_regions > 0 ? header.m_regions : 1;
    return bakedFileBytes(header) - alignedBytes(count * sizeof(BakedConstants));
}

BakedFileInfo infoOf(const BakedHeader& h)
{
    BakedFileInfo info;
    info.m_version = static_cast<int>(h.m_version);
    info.m_fileBytes = h.m_fileBytes;
    info.m_factorBytes = sizeof(float) * h.m_panelFloats;
    info.m_nodes = static_cast<int>(h.m_nodes);
    info.m_tets = static_cast<int>(h.m_tets);
    info.m_freeNodes = static_cast<int>(h.m_freeNodes);
    info.m_embeddedVertices = static_cast<int>(h.m_embedded);
    info.m_embeddedTriangles = static_cast<int>(h.m_triangles);
    info.m_surfaceCollides = h.m_surfaceCollides == 1;
    info.m_material = materialOf(h);
    info.m_regions = std::max(1, static_cast<int>(h.m_regions));
    info.m_step = h.m_step;
    info.m_singlePrecision = h.m_singlePrecision == 1;
    info.m_factor.m_backend = h.m_backend.data();
    info.m_factor.m_ordering = h.m_ordering.data();
    info.m_factor.m_entries = static_cast<long>(h.m_entries);
    info.m_factor.m_supernodes = static_cast<int>(h.m_supernodes);
    info.m_factor.m_path = h.m_lowMemory ? FactorPath::lowMemory : FactorPath::full;
    info.m_factor.m_bytes = info.m_factorBytes;
    info.m_factor.m_fullBytes = h.m_fullBytes;
    info.m_factor.m_baked = true;
    return info;
}

}  // namespace bullet_fem
