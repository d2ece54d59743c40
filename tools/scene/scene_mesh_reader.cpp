// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_mesh_reader.h"

#include <filesystem>
#include <system_error>

#include "tools/scene/scene_place_reader.h"

namespace bullet_fem
{
namespace
{

constexpr JsonRange kEdge = {0, 1e6, true};

std::string fileIn(const std::string& folder, const JsonCursor& at)
{
    const std::filesystem::path path = std::filesystem::path(folder) / at.text();
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) at.fail("names '" + path.string() + "', which is no file");
    return path.string();
}

// Reads the kind of the mesh and the members of that kind.
void readKind(const JsonCursor& at, const std::string& folder, SceneMesh& mesh)
{
    int kinds = 0;
    for (const char* name : {"box", "sphere", "cylinder", "surface", "tetrahedra", "baked"}) kinds += at.has(name);
    if (kinds != 1) at.fail("must have one of: box, sphere, cylinder, surface, tetrahedra, baked");
    if (at.has("box"))
        mesh.m_size = at["box"].vector(kEdge);
    else if (at.has("sphere"))
    {
        mesh.m_kind = SceneMesh::Kind::sphere;
        mesh.m_radius = at["sphere"].number(kEdge);
    }
    else if (at.has("cylinder"))
    {
        mesh.m_kind = SceneMesh::Kind::cylinder;
        readRound(at["cylinder"], mesh.m_radius, mesh.m_height);
    }
    else
    {
        const bool surface = at.has("surface"), baked = at.has("baked");
        mesh.m_kind = surface ? SceneMesh::Kind::surface : baked ? SceneMesh::Kind::baked : SceneMesh::Kind::tetrahedra;
        mesh.m_path = fileIn(folder, at[surface ? "surface" : baked ? "baked" : "tetrahedra"]);
    }
}

// Throws if a member has no effect for this kind.
void refuseWhatTheKindHasNot(const JsonCursor& at, SceneMesh::Kind kind)
{
    if (kind != SceneMesh::Kind::box && at.has("holes"))
        at["holes"].fail("are given, but only a 'box' has some; leave them out");
    const bool hasElements = kind == SceneMesh::Kind::tetrahedra || kind == SceneMesh::Kind::baked;
    for (const char* name : {"cell", "tets"})
        if (hasElements && at.has(name)) at[name].fail("is given, but the file has its elements; leave it out");
    for (const char* name : {"grade", "levels"})
        if (kind != SceneMesh::Kind::surface && at.has(name))
            at[name].fail("is given, but only cages around a surface are graded; leave it out");
    if (at.has("levels") && !at.has("grade")) at["levels"].fail("is given without 'grade'; give that, too");
    if (kind == SceneMesh::Kind::baked && at.has("scale"))
        at["scale"].fail("is given, but a baked body has its size; leave it out, or bake it anew");
    if (at.has("cell") && at.has("tets")) at.fail("has 'cell' and 'tets'; give one of them");
    if (kind != SceneMesh::Kind::surface && at.has("surfaceCollides"))
        at["surfaceCollides"].fail("is for a 'surface' with a cage around it; a baked body has it from baking");
}

}  // namespace

SceneMesh readMesh(const JsonCursor& at, const std::string& folder)
{
    at.onlyMembers({"box", "sphere", "cylinder", "surface", "tetrahedra", "baked", "holes", "cell", "tets", "grade",
                    "levels", "scale", "surfaceCollides"});
    SceneMesh mesh;
    readKind(at, folder, mesh);
    refuseWhatTheKindHasNot(at, mesh.m_kind);
    at.forEach("holes", [&](const JsonCursor& item) { mesh.m_holes.push_back(readBox(item)); });
    at.read("cell", kEdge, mesh.m_cellSize);
    at.read("tets", 5, 5000000, mesh.m_tets);
    at.read("grade", {0.5, 8}, mesh.m_cellsAcross);
    at.read("levels", 1, 6, mesh.m_mostLevels);
    at.read("scale", {0, 1e9, true}, mesh.m_scale);
    at.read("surfaceCollides", mesh.m_surfaceCollides);
    return mesh;
}

}  // namespace bullet_fem
