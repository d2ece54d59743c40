// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <chrono>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "fem/baked/baked_checks.h"
#include "fem/baked/baked_header.h"
#include "fem/baked/file_bytes.h"
#include "fem/common/attempt.h"
#include "fem/common/message.h"
#include "fem/common/reason.h"
#include "fem/factor/rest_factor.h"

namespace bullet_fem
{
namespace
{

// Adds the file's name to exceptions.
template <class Read>
auto readNamed(const std::string& name, const Read& read)
{
    try
    {
        return read();
    }
    catch (const std::exception& error)
    {
        throw std::runtime_error("cannot read '" + name + "': " + reasonOf(error));
    }
}

BakedArrays readArrays(const BakedHeader& header, const unsigned char* data)
{
    BakedArrays arrays;
    std::uint64_t at = alignedBytes(sizeof header + sizeof(float) * header.m_panelFloats);
    forEachSection(arrays, header,
                   [&](auto& array, std::size_t count)
                   {
                       array.resize(count);
                       const std::size_t bytes = count * sizeof array[0];
                       if (bytes > 0) std::memcpy(array.data(), data + at, bytes);
                       at = alignedBytes(at + bytes);
                   });
    return arrays;
}

// The factor with its own node numbering; panels stay in the file's memory.
std::shared_ptr<const RestFactor> factorOf(const BakedHeader& header, BakedArrays& arrays, const FileBytes& file)
{
    SupernodeTree tree = checkedTree(header, arrays);
    std::vector<int> position = checkedPositions(arrays);
    checkRestMatrix(header, arrays);
    const auto* const panels = reinterpret_cast<const float*>(file.m_data.get() + sizeof header);
    checkPanels(panels, header.m_panelFloats);
    PackedFactor lower;
    if (header.m_freeNodes > 0)
        lower = PackedFactor(std::move(tree), header.m_lowMemory ? NodeEntry::number : NodeEntry::block,
                             std::shared_ptr<const float>(file.m_data, panels));
    RestMatrix rest;
    if (header.m_lowMemory)
    {
        rest.m_rowStart = std::move(arrays.m_restRowStart);
        rest.m_column = std::move(arrays.m_restColumn);
        rest.m_values = std::move(arrays.m_restValues);
    }
    return std::make_shared<const RestFactor>(std::move(position), std::move(arrays.m_diagonal), std::move(lower),
                                              std::move(rest));
}

void refuseFreeLooseNodes(const TetMesh& mesh, const std::vector<unsigned char>& fixed)
{
    for (int i = 0; i < mesh.nodeCount(); ++i)
        if (mesh.isLoose(i) && !fixed[i]) reject("node ", i, " belongs to no element and is not fixed");
}

BakedBody assemble(const BakedHeader& header, BakedArrays arrays, const FileBytes& file)
{
    checkValues(header, arrays);
    std::vector<Vec3> X = arrays.m_positions;
    for (Vec3& x : X) x -= arrays.m_positions[0];
    const ElementMaterials materials = materialsOf(header, arrays);
    auto shape = std::make_shared<const RestShape>(
        TetMesh::withSides(std::move(X), std::move(arrays.m_tets), arrays.m_sides), materials, arrays.m_filled);
    refuseFreeLooseNodes(shape->m_mesh, arrays.m_fixed);

    FactorOfModel factor;
    factor.m_factor = factorOf(header, arrays, file);
    for (const double inverse : arrays.m_inverseMass) factor.m_input.m_mass.push_back(1 / inverse);
    factor.m_input.m_fixed = std::move(arrays.m_fixed);
    factor.m_input.m_step = header.m_step;
    factor.m_materials = materials;
    factor.m_report = infoOf(header).m_factor;
    BakedBody body;
    for (std::size_t v = 0; v < arrays.m_vertexTet.size(); ++v)
        body.m_embedding.push_back({arrays.m_vertexTet[v], arrays.m_weights[v]});
    body.m_positions = std::move(arrays.m_positions);
    body.m_inverseMass = std::move(arrays.m_inverseMass);
    body.m_filled = std::move(arrays.m_filled);
    body.m_massScale = header.m_massScale;
    body.m_triangles = std::move(arrays.m_triangles);
    body.m_singlePrecision = header.m_singlePrecision == 1;
    body.m_surfaceCollides = header.m_surfaceCollides == 1;
    body.m_model = BodyModel::withFactor(std::move(shape), std::move(factor));
    return body;
}

BakedBody open(const FileBytes& file)
{
    const unsigned char* const data = file.m_data.get();
    const BakedHeader header = openHeader(data, file.m_size, file.m_size);
    if (checksumOf(data + sizeof header, file.m_size - sizeof header) != header.m_bodyChecksum)
        reject("its bytes are not those that were written: it is damaged; copy or bake it anew");
    try
    {
        return assemble(header, readArrays(header, data), file);
    }
    catch (const std::invalid_argument& error)
    {
        reject("it is no body: ", reasonOf(error), "; bake it anew");
    }
}

}  // namespace

BakedBody readBakedBody(const std::string& path, BakedLoading loading, std::string* why)
{
    const auto read = [&] { return open(loading == BakedLoading::mapped ? mapFile(path) : readFile(path)); };
    return attemptValue(why, [&] { return readNamed(path, read); });
}

BakedBody readBakedBody(const unsigned char* data, std::size_t size, const std::string& name, std::string* why)
{
    const auto read = [&]
    {
        if (!data && size > 0) reject("its bytes are null");
        return open(copyBytes(data, size));
    };
    return attemptValue(why, [&] { return readNamed(name, read); });
}

BakedFileInfo inspectBakedBody(const std::string& path, std::string* why)
{
    const auto inspect = [&path]
    {
        const std::uint64_t length = fileLength(path);
        unsigned char begin[sizeof(BakedHeader)] = {};
        std::ifstream file(path, std::ios::binary);
        if (!file) throw std::runtime_error("it cannot be opened; check its permissions");
        file.read(reinterpret_cast<char*>(begin), sizeof begin);
        const BakedHeader header = openHeader(begin, static_cast<std::size_t>(file.gcount()), length);
        BakedFileInfo info = infoOf(header);
        if (!hasBakedConstants(info.m_material)) return info;
        BakedConstants constants;
        file.seekg(static_cast<std::streamoff>(constantsOffset(header)));
        file.read(reinterpret_cast<char*>(&constants), sizeof constants);
        if (!file) reject("the constants of its law cannot be read; copy or bake it anew");
        info.m_material = withConstants(info.m_material, constants);
        return info;
    };
    return attemptValue(why, [&] { return readNamed(path, inspect); });
}

}  // namespace bullet_fem
