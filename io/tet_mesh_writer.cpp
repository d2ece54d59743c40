// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/tet_mesh_writer.h"

#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "fem/common/output_file.h"
#include "io/file_bytes.h"

namespace bullet_fem
{
namespace
{

/// Text of numbers with blanks between them; as few digits as give back the same bits.
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

std::string gmshText(const TetMesh& mesh)
{
    NumberLines out;
    out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << mesh.nodeCount() << "\n";
    for (int i = 0; i < mesh.nodeCount(); ++i) out << i + 1 << mesh.restPositions()[i] << "\n";
    out << "$EndNodes\n$Elements\n" << mesh.tetCount() << "\n";
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        out << e + 1 << "4 0 ";  // a tetrahedron without tags
        out.nodes(mesh.tets()[e], 1);
        out << "\n";
    }
    out << "$EndElements\n";
    return out.text();
}

std::string vtkText(const TetMesh& mesh)
{
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
    return out.text();
}

std::string meditText(const TetMesh& mesh)
{
    NumberLines out;
    out << "MeshVersionFormatted 2\nDimension 3\nVertices\n" << mesh.nodeCount() << "\n";
    for (const Vec3& x : mesh.restPositions()) out << x << "0\n";
    out << "Tetrahedra\n" << mesh.tetCount() << "\n";
    for (const Tet& tet : mesh.tets())
    {
        out.nodes(tet, 1);
        out << "0\n";
    }
    out << "End\n";
    return out.text();
}

std::string nodeText(const TetMesh& mesh)
{
    NumberLines out;
    out << mesh.nodeCount() << "3 0 0\n";
    for (int i = 0; i < mesh.nodeCount(); ++i) out << i + 1 << mesh.restPositions()[i] << "\n";
    return out.text();
}

std::string eleText(const TetMesh& mesh)
{
    NumberLines out;
    out << mesh.tetCount() << "4 0\n";
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        out << e + 1;
        out.nodes(mesh.tets()[e], 1);
        out << "\n";
    }
    return out.text();
}

std::string withEnding(const std::string& path, const char* ending)
{
    return std::filesystem::path(path).replace_extension(ending).string();
}

// One is nothing without the other.
void writeTetGen(const std::string& path, const TetMesh& mesh)
{
    OutputFile nodes(withEnding(path, ".node")), elements(withEnding(path, ".ele"));
    const std::string nodeLines = nodeText(mesh), elementLines = eleText(mesh);
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
                             "' is not known; it must be .msh, .vtk, .mesh, .node or .ele");
}

}  // namespace

void checkTetMeshOutput(const std::string& path)
{
    const std::string ending = lowerCaseEnding(path);
    if (ending == ".msh" || ending == ".vtk" || ending == ".mesh") return checkWritable(path);
    if (ending != ".node" && ending != ".ele") failEnding(path);
    checkWritable(withEnding(path, ".node"));
    checkWritable(withEnding(path, ".ele"));
}

void writeTetMeshFile(const std::string& path, const TetMesh& mesh)
{
    const std::string ending = lowerCaseEnding(path);
    if (ending == ".msh") return writeOutputFile(path, gmshText(mesh));
    if (ending == ".vtk") return writeOutputFile(path, vtkText(mesh));
    if (ending == ".mesh") return writeOutputFile(path, meditText(mesh));
    if (ending == ".node" || ending == ".ele") return writeTetGen(path, mesh);
    failEnding(path);
}

}  // namespace bullet_fem
