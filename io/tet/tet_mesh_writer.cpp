// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/tet_mesh_writer.h"

#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "fem/common/message.h"
#include "fem/common/output_file.h"
#include "io/frames/vtu_frame.h"
#include "io/text/file_bytes.h"

namespace bullet_fem
{
namespace
{

/// Numbers as text with blanks between them, with the fewest digits for an exact round trip.
class NumberLines
{
public:
    NumberLines& operator<<(const char* text)
    {
        m_text += text;
        return *this;
    }
    template <class Number>
    NumberLines& operator<<(Number value)
    {
        char digits[32];
        const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
        m_text.append(digits, end);
        m_text += ' ';
        return *this;
    }
    NumberLines& operator<<(const Vec3& x) { return *this << x.x << x.y << x.z; }
    void nodes(const Tet& tet, int first)
    {
        for (const int node : tet) *this << node + first;
    }

    const std::string& text() const { return m_text; }

private:
    std::string m_text;
};

/// A mesh with optional labels of its elements.
struct LabelledMesh
{
    const TetMesh& m_mesh;
    const std::vector<int>& m_regions;

    bool hasRegions() const { return !m_regions.empty(); }
    int region(int e) const { return hasRegions() ? m_regions[static_cast<std::size_t>(e)] : 0; }
};

std::string gmshText(const LabelledMesh& labelled)
{
    const TetMesh& mesh = labelled.m_mesh;
    NumberLines out;
    out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << mesh.nodeCount() << "\n";
    for (int i = 0; i < mesh.nodeCount(); ++i) out << i + 1 << mesh.restPositions()[i] << "\n";
    out << "$EndNodes\n$Elements\n" << mesh.tetCount() << "\n";
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        out << e + 1;
        if (labelled.hasRegions())
            out << "4 2 " << labelled.region(e) << "1 ";  // a physical group, and a volume
        else
            out << "4 0 ";  // a tetrahedron without tags
        out.nodes(mesh.tets()[e], 1);
        out << "\n";
    }
    out << "$EndElements\n";
    return out.text();
}

std::string vtkText(const LabelledMesh& labelled)
{
    const TetMesh& mesh = labelled.m_mesh;
    NumberLines out;
    out << "# vtk DataFile Version 2.0\nBulletFEM\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << mesh.nodeCount()
        << "double\n";
    for (const Vec3& x : mesh.restPositions()) out << x << "\n";
    out << "CELLS " << mesh.tetCount() << 5L * mesh.tetCount() << "\n";
    for (const Tet& tet : mesh.tets())
    {
        out << "4 ";
        out.nodes(tet, 0);
        out << "\n";
    }
    out << "CELL_TYPES " << mesh.tetCount() << "\n";
    for (int e = 0; e < mesh.tetCount(); ++e) out << "10\n";
    if (!labelled.hasRegions()) return out.text();
    out << "CELL_DATA " << mesh.tetCount() << "\nSCALARS region int 1\nLOOKUP_TABLE default\n";
    for (const int region : labelled.m_regions) out << region << "\n";
    return out.text();
}

std::string meditText(const LabelledMesh& labelled)
{
    const TetMesh& mesh = labelled.m_mesh;
    NumberLines out;
    out << "MeshVersionFormatted 2\nDimension 3\nVertices\n" << mesh.nodeCount() << "\n";
    for (const Vec3& x : mesh.restPositions()) out << x << "0\n";
    out << "Tetrahedra\n" << mesh.tetCount() << "\n";
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        out.nodes(mesh.tets()[e], 1);
        out << labelled.region(e) << "\n";
    }
    out << "End\n";
    return out.text();
}

// Counted from 0: Bullet's CreateFromTetGenData uses the numbers as array indices.
std::string nodeText(const TetMesh& mesh)
{
    NumberLines out;
    out << mesh.nodeCount() << "3 0 0\n";
    for (int i = 0; i < mesh.nodeCount(); ++i) out << i << mesh.restPositions()[i] << "\n";
    return out.text();
}

std::string eleText(const LabelledMesh& labelled)
{
    const TetMesh& mesh = labelled.m_mesh;
    NumberLines out;
    out << mesh.tetCount() << (labelled.hasRegions() ? "4 1\n" : "4 0\n");
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        out << e;
        out.nodes(mesh.tets()[e], 0);
        if (labelled.hasRegions()) out << labelled.region(e);
        out << "\n";
    }
    return out.text();
}

std::string withEnding(const std::string& path, const char* ending)
{
    return std::filesystem::path(path).replace_extension(ending).string();
}

// Neither file is useful without the other.
void writeTetGen(const std::string& path, const LabelledMesh& labelled)
{
    OutputFile nodes(withEnding(path, ".node")), elements(withEnding(path, ".ele"));
    const std::string nodeLines = nodeText(labelled.m_mesh), elementLines = eleText(labelled);
    nodes.write(nodeLines.data(), nodeLines.size());
    elements.write(elementLines.data(), elementLines.size());
    nodes.sync();
    elements.sync();
    nodes.commit();
    elements.commit();
}

[[noreturn]] void failEnding(const std::string& path)
{
    throw std::runtime_error("cannot write the mesh file '" + path + "': the ending '" + lowerCaseEnding(path) +
                             "' is not known; it must be .msh, .vtk, .vtu, .mesh, .node or .ele");
}

}  // namespace

void checkTetMeshOutput(const std::string& path)
{
    const std::string ending = lowerCaseEnding(path);
    if (ending == ".msh" || ending == ".vtk" || ending == ".vtu" || ending == ".mesh") return checkWritable(path);
    if (ending != ".node" && ending != ".ele") failEnding(path);
    checkWritable(withEnding(path, ".node"));
    checkWritable(withEnding(path, ".ele"));
}

void writeTetMeshFile(const std::string& path, const TetMesh& mesh, const std::vector<int>& regions)
{
    if (!regions.empty() && regions.size() != mesh.tets().size())
        reject("writeTetMeshFile: there are ", regions.size(), " regions for ", mesh.tetCount(),
               " elements; give one each, or none");
    const LabelledMesh labelled{mesh, regions};
    const std::string ending = lowerCaseEnding(path);
    if (ending == ".msh") return writeOutputFile(path, gmshText(labelled));
    if (ending == ".vtk") return writeOutputFile(path, vtkText(labelled));
    if (ending == ".vtu") return writeOutputFile(path, vtuMesh(mesh, regions));
    if (ending == ".mesh") return writeOutputFile(path, meditText(labelled));
    if (ending == ".node" || ending == ".ele") return writeTetGen(path, labelled);
    failEnding(path);
}

}  // namespace bullet_fem
