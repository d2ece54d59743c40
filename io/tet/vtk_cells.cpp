// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/tet/vtk_cells.h"

#include <algorithm>
#include <stdexcept>

#include "fem/common/message.h"
#include "io/tet/cell_kind.h"

namespace bullet_fem
{
namespace
{

// VTK's list (vtkCellType.h), with poly vertices, poly lines, strips and pixels, and cells of higher order.
constexpr int kPoints[] = {1, 2};
constexpr int kEdges[] = {3, 4, 21, 35, 68, 75};
constexpr int kFaces[] = {5, 6, 7, 8, 9, 22, 23, 28, 30, 34, 36, 69, 70, 76, 77};

struct RefusedType
{
    int type;
    const char* name;  // with its article
};

constexpr RefusedType kRefused[] = {{11, "a voxel"},
                                    {12, "a hexahedron"},
                                    {13, "a wedge"},
                                    {14, "a pyramid"},
                                    {15, "a pentagonal prism"},
                                    {16, "a hexagonal prism"},
                                    {24, "a quadratic tetrahedron (10 nodes)"},
                                    {25, "a quadratic hexahedron"},
                                    {26, "a quadratic wedge"},
                                    {27, "a quadratic pyramid"},
                                    {29, "a triquadratic hexahedron"},
                                    {31, "a quadratic linear wedge"},
                                    {32, "a biquadratic quadratic wedge"},
                                    {33, "a biquadratic quadratic hexahedron"},
                                    {37, "a triquadratic pyramid"},
                                    {41, "a convex point set"},
                                    {42, "a polyhedron"},
                                    {71, "a Lagrange tetrahedron"},
                                    {72, "a Lagrange hexahedron"},
                                    {73, "a Lagrange wedge"},
                                    {74, "a Lagrange pyramid"},
                                    {78, "a Bezier tetrahedron"},
                                    {79, "a Bezier hexahedron"},
                                    {80, "a Bezier wedge"},
                                    {81, "a Bezier pyramid"}};

template <std::size_t Size>
bool isIn(std::int64_t type, const int (&types)[Size])
{
    return std::find(types, types + Size, type) != types + Size;
}

/// Treatment of cells of this type; throws, naming the type, if they are refused.
CellKind kindOf(std::int64_t type, std::size_t cell)
{
    if (type == 0) return CellKind::empty;
    if (type == kVtkTetrahedron) return CellKind::tet;
    if (isIn(type, kPoints)) return CellKind::point;
    if (isIn(type, kEdges)) return CellKind::edge;
    if (isIn(type, kFaces)) return CellKind::face;
    std::string name = message("VTK's cell type ", type);
    for (const RefusedType& known : kRefused)
        if (known.type == type) name = message(known.name, ", VTK's cell type ", type, ",");
    throw std::runtime_error(message("cell ", cell, ": ", refusalOf(name)));
}

}  // namespace

void appendVtkCells(TetMeshFile& mesh, const VtkCells& cells, std::size_t firstPoint)
{
    if (cells.m_types.size() != cells.m_ends.size())
        throw std::runtime_error(
            message("there are ", cells.m_types.size(), " cell types for ", cells.m_ends.size(), " cells"));
    const auto pointCount = static_cast<std::int64_t>(mesh.m_positions.size() - firstPoint);
    const auto cornerCount = static_cast<std::int64_t>(cells.m_connectivity.size());
    std::int64_t begin = 0;
    for (std::size_t c = 0; c < cells.m_ends.size(); ++c)
    {
        const std::int64_t end = cells.m_ends[c];
        if (end < begin || end > cornerCount)
            throw std::runtime_error(message("the corners of cell ", c, " end at ", end, ", which is not in [", begin,
                                             ", ", cornerCount, "]"));
        const CellKind kind = kindOf(cells.m_types[c], c);
        if (kind == CellKind::tet)
        {
            if (end - begin != 4)
                throw std::runtime_error(message("cell ", c, " is a tetrahedron with ", end - begin, " corners"));
            Tet tet;
            for (int a = 0; a < 4; ++a)
            {
                const std::int64_t point = cells.m_connectivity[static_cast<std::size_t>(begin + a)];
                if (point < 0 || point >= pointCount)
                    throw std::runtime_error(
                        message("cell ", c, " uses point ", point, ", which is not in [0, ", pointCount, ")"));
                tet[a] = static_cast<int>(static_cast<std::int64_t>(firstPoint) + point);
            }
            mesh.m_tets.push_back(tet);
        }
        else
            countSkipped(mesh, kind, 1);
        begin = end;
    }
}

bool isVtkRegionName(std::string name)
{
    for (char& c : name)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    for (const char* known :
         {"region", "regions", "material", "materialids", "cellentityids", "gmsh:physical", "medit:ref", "attribute"})
        if (name == known) return true;
    return false;
}

void noteVtkRegions(TetMeshFile& mesh, const VtkCells& cells, const std::vector<double>& regions)
{
    if (regions.size() != cells.m_types.size()) return;
    const auto isTet = [](std::int64_t type) { return type == kVtkTetrahedron; };
    std::size_t tet =
        mesh.m_tets.size() - static_cast<std::size_t>(std::count_if(cells.m_types.begin(), cells.m_types.end(), isTet));
    mesh.m_regions.resize(mesh.m_tets.size(), 0);
    for (std::size_t c = 0; c < regions.size(); ++c)
        if (isTet(cells.m_types[c])) mesh.m_regions[tet++] = regionOf(regions[c]);
}

}  // namespace bullet_fem
