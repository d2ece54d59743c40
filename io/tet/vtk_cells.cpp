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

struct VtkType
{
    int type;
    CellKind kind;
    const char* name;  // with its article, of refused ones
};

/// VTK's list (vtkCellType.h).
constexpr VtkType kTypes[] = {{0, CellKind::empty, ""},
                              {1, CellKind::point, ""},
                              {2, CellKind::point, ""},  // poly vertex
                              {3, CellKind::edge, ""},
                              {4, CellKind::edge, ""},  // poly line
                              {5, CellKind::face, ""},
                              {6, CellKind::face, ""},  // strip
                              {7, CellKind::face, ""},
                              {8, CellKind::face, ""},  // pixel
                              {9, CellKind::face, ""},
                              {kVtkTetrahedron, CellKind::tet, ""},
                              {11, CellKind::refused, "a voxel"},
                              {12, CellKind::refused, "a hexahedron"},
                              {13, CellKind::refused, "a wedge"},
                              {14, CellKind::refused, "a pyramid"},
                              {15, CellKind::refused, "a pentagonal prism"},
                              {16, CellKind::refused, "a hexagonal prism"},
                              {21, CellKind::edge, ""},  // lines and polygons of second and third order
                              {22, CellKind::face, ""},
                              {23, CellKind::face, ""},
                              {24, CellKind::refused, "a quadratic tetrahedron (10 nodes)"},
                              {25, CellKind::refused, "a quadratic hexahedron"},
                              {26, CellKind::refused, "a quadratic wedge"},
                              {27, CellKind::refused, "a quadratic pyramid"},
                              {28, CellKind::face, ""},
                              {29, CellKind::refused, "a triquadratic hexahedron"},
                              {30, CellKind::face, ""},
                              {31, CellKind::refused, "a quadratic linear wedge"},
                              {32, CellKind::refused, "a biquadratic quadratic wedge"},
                              {33, CellKind::refused, "a biquadratic quadratic hexahedron"},
                              {34, CellKind::face, ""},
                              {35, CellKind::edge, ""},
                              {36, CellKind::face, ""},
                              {37, CellKind::refused, "a triquadratic pyramid"},
                              {41, CellKind::refused, "a convex point set"},
                              {42, CellKind::refused, "a polyhedron"},
                              {68, CellKind::edge, ""},  // Lagrange
                              {69, CellKind::face, ""},
                              {70, CellKind::face, ""},
                              {71, CellKind::refused, "a Lagrange tetrahedron"},
                              {72, CellKind::refused, "a Lagrange hexahedron"},
                              {73, CellKind::refused, "a Lagrange wedge"},
                              {74, CellKind::refused, "a Lagrange pyramid"},
                              {75, CellKind::edge, ""},  // Bezier
                              {76, CellKind::face, ""},
                              {77, CellKind::face, ""},
                              {78, CellKind::refused, "a Bezier tetrahedron"},
                              {79, CellKind::refused, "a Bezier hexahedron"},
                              {80, CellKind::refused, "a Bezier wedge"},
                              {81, CellKind::refused, "a Bezier pyramid"}};

/// Treatment of cells of this type; throws, naming the type, if they are refused.
CellKind kindOf(std::int64_t type, std::size_t cell)
{
    for (const VtkType& known : kTypes)
        if (known.type == type && known.kind != CellKind::refused) return known.kind;
    std::string name = message("VTK's cell type ", type);
    for (const VtkType& known : kTypes)
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
