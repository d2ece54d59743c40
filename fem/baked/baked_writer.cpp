// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>

#include "fem/baked/baked_checks.h"
#include "fem/baked/baked_header.h"
#include "fem/common/attempt.h"
#include "fem/common/message.h"
#include "fem/common/output_file.h"
#include "fem/common/reason.h"
#include "fem/factor/rest_factor.h"

namespace bullet_fem
{
namespace
{

template <std::size_t size>
void setText(std::array<char, size>& out, const std::string& text)
{
    std::copy_n(text.begin(), std::min(text.size(), size - 1), out.begin());
}

std::uint32_t countOf(std::size_t size)
{
    if (size > UINT32_MAX) reject("it has lists of ", size, " entries; make a coarser mesh");
    return static_cast<std::uint32_t>(size);
}

BakedPlasticity plasticityOf(const Material& material)
{
    if (!material.yields()) return {};
    return {static_cast<float>(material.m_yieldStress), static_cast<float>(material.m_hardeningModulus),
            static_cast<float>(material.m_plasticCreep), static_cast<float>(material.m_mostPlasticStrain)};
}

BakedConstants constantsOf(const Material& material)
{
    if (!material.isOrthotropic())
    {
        const std::array<double, kMaxLawConstants>& c = material.m_lawConstants;
        return {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {}, {}, {}};
    }
    const Orthotropic& m = material.m_orthotropic;
    return {m.m_young, m.m_poisson, m.m_shear, m.m_along, m.m_across};
}

BakedHeader headerOf(const BakedBody& body, const BakedArrays& arrays)
{
    const BodyModel& model = *body.m_model;
    const FactorReport& report = model.factorReport();
    const Material& material = model.shape().m_material;
    BakedHeader h = {};
    h.m_panelFloats = model.factor().lower().floatCount();
    h.m_entries = static_cast<std::uint64_t>(report.m_entries);
    h.m_fullBytes = report.m_fullBytes;
    h.m_nodes = countOf(arrays.m_positions.size());
    h.m_tets = countOf(arrays.m_tets.size());
    h.m_filled = countOf(arrays.m_filled.size());
    h.m_embedded = countOf(arrays.m_vertexTet.size());
    h.m_triangles = countOf(arrays.m_triangles.size());
    h.m_freeNodes = countOf(arrays.m_order.size());
    h.m_supernodes = countOf(arrays.m_supernodes.size());
    h.m_rows = countOf(arrays.m_row.size());
    h.m_restBlocks = countOf(arrays.m_restColumn.size());
    h.m_regions = countOf(arrays.m_regions.size());
    if (!arrays.m_constants.empty()) h.m_version = kBakedConstantsVersion;
    h.m_lowMemory = h.m_restBlocks > 0;
    h.m_surfaceCollides = body.m_surfaceCollides;
    h.m_singlePrecision = body.m_singlePrecision;
    h.m_step = model.factorInput().m_step;
    h.m_massScale = body.m_massScale;
    h.m_youngModulus = material.m_youngModulus;
    h.m_poissonRatio = material.m_poissonRatio;
    h.m_density = material.m_density;
    h.m_massDamping = material.m_massDamping;
    h.m_stiffnessDamping = material.m_stiffnessDamping;
    h.m_meanDilatation = averagingOf(material);
    h.m_plasticity = plasticityOf(material);
    setText(h.m_backend, report.m_backend);
    setText(h.m_ordering, report.m_ordering);
    return h;
}

BakedArrays arraysOf(const BakedBody& body)
{
    const BodyModel& model = *body.m_model;
    const RestFactor& factor = model.factor();
    BakedArrays a;
    a.m_positions = body.m_positions;
    a.m_inverseMass = body.m_inverseMass;
    a.m_filled = body.m_filled;
    a.m_tets = model.mesh().tets();
    a.m_sides = model.mesh().boundarySides();
    a.m_fixed = model.factorInput().m_fixed;
    a.m_triangles = body.m_triangles;
    for (const Embedding& vertex : body.m_embedding)
    {
        a.m_vertexTet.push_back(vertex.m_tet);
        a.m_weights.push_back(vertex.m_weights);
    }
    a.m_order.resize(factor.freeNodeCount());
    for (int i = 0; i < model.nodeCount(); ++i)
    {
        a.m_diagonal.push_back(factor.diagonal(i));
        if (factor.position(i) >= 0) a.m_order[factor.position(i)] = i;
    }
    for (const Supernode& s : factor.lower().tree().m_supernodes)
        a.m_supernodes.push_back({s.m_columns, s.m_rows, s.m_parent});
    a.m_row = factor.lower().tree().m_row;
    if (factor.rest().nodeCount() > 0)
    {
        a.m_restRowStart = factor.rest().m_rowStart;
        a.m_restColumn = factor.rest().m_column;
        a.m_restValues = factor.rest().m_values;
    }
    const ElementMaterials& materials = model.shape().m_materials;
    if (std::any_of(materials.m_regions.begin(), materials.m_regions.end(),
                    [](const MaterialRegion& region) { return hasBakedConstants(region.m_material); }))
        for (const auto& [label, m] : materials.m_regions) a.m_constants.push_back(constantsOf(m));
    if (materials.isUniform()) return a;
    a.m_regionOf = materials.m_regionOf;
    for (const auto& [label, m] : materials.m_regions)
        a.m_regions.push_back({label, averagingOf(m), m.m_youngModulus, m.m_poissonRatio, m.m_density, m.m_massDamping,
                               m.m_stiffnessDamping, plasticityOf(m)});
    return a;
}

// A body assembled by the caller may be inconsistent.
void check(const BakedBody& body)
{
    if (!body.m_model) reject("it has no model; make it with bakeBody");
    const std::size_t n = body.m_model->nodeCount();
    if (body.m_positions.size() != n || body.m_inverseMass.size() != n)
        reject("it has ", body.m_positions.size(), " positions and ", body.m_inverseMass.size(), " inverse masses for ",
               n, " nodes");
    for (const auto& [label, material] : body.m_model->shape().m_materials.m_regions)
        if (material.relaxationTerms() > 0)
            reject(
                "its material has relaxation terms, which a file does not keep; bake it without, and give them to the "
                "body that is read with setMaterial: the factor stays exact");
    if (body.m_model->shape().m_materials != body.m_model->sharedFactor().m_materials)
        reject("its factor was made for another material; bake it for the one that it has");
}

std::vector<unsigned char> bytesOf(const BakedBody& body)
{
    check(body);
    BakedArrays arrays = arraysOf(body);
    BakedHeader header = headerOf(body, arrays);
    std::vector<unsigned char> bytes(bakedFileBytes(header), 0);
    const PackedFactor& lower = body.m_model->factor().lower();
    if (lower.floatCount() > 0) std::memcpy(bytes.data() + sizeof header, lower.panels(), lower.byteCount());
    std::uint64_t at = alignedBytes(sizeof header + lower.byteCount());
    forEachSection(arrays, header,
                   [&](const auto& array, std::size_t count)
                   {
                       if (array.size() != count) reject("it has lists that do not fit together");
                       if (count > 0) std::memcpy(bytes.data() + at, array.data(), count * sizeof array[0]);
                       at = alignedBytes(at + count * sizeof array[0]);
                   });
    checkValues(header, arrays);
    sealHeader(header, bytes.data() + sizeof header, bytes.size() - sizeof header);
    std::memcpy(bytes.data(), &header, sizeof header);
    openHeader(bytes.data(), bytes.size(), bytes.size());  // so that no unreadable file is written
    return bytes;
}

}  // namespace

bool writeBakedBody(const std::string& path, const BakedBody& body, std::string* why)
{
    return attempt(why,
                   [&]
                   {
                       std::vector<unsigned char> bytes;
                       try
                       {
                           bytes = bytesOf(body);
                       }
                       catch (const std::exception& error)
                       {
                           throw std::runtime_error("cannot write '" + path + "': " + reasonOf(error));
                       }
                       OutputFile file(path);
                       file.write(bytes.data(), bytes.size());
                       file.sync();
                       file.commit();
                   });
}

}  // namespace bullet_fem
