// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/tet/gmsh_cells.h"

#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

struct Counted
{
    int type, nodes;
};

constexpr Counted kLines[] = {{1, 2}, {8, 3}, {26, 4}, {27, 5}, {28, 6}, {62, 7}, {63, 8}, {64, 9}, {65, 10}, {66, 11}};
constexpr Counted kFaces[] = {
    // triangles
    {2, 3},
    {9, 6},
    {20, 9},
    {21, 10},
    {22, 12},
    {23, 15},
    {24, 15},
    {25, 21},
    {42, 28},
    {43, 36},
    {44, 45},
    {45, 55},
    {46, 66},
    {52, 18},
    {53, 21},
    {54, 24},
    {55, 27},
    {56, 30},
    // quadrangles
    {3, 4},
    {10, 9},
    {16, 8},
    {36, 16},
    {37, 25},
    {38, 36},
    {39, 12},
    {40, 16},
    {41, 20},
    {47, 49},
    {48, 64},
    {49, 81},
    {50, 100},
    {51, 121},
    {57, 24},
    {58, 28},
    {59, 32},
    {60, 36},
    {61, 40}};

struct NamedCell
{
    int type;
    const char* name;
};

constexpr NamedCell kVolumes[] = {{5, "a hexahedron"},
                                  {6, "a prism"},
                                  {7, "a pyramid"},
                                  {11, "a tetrahedron of second order (10 nodes)"},
                                  {12, "a hexahedron of second order (27 nodes)"},
                                  {13, "a prism of second order (18 nodes)"},
                                  {14, "a pyramid of second order (14 nodes)"},
                                  {17, "a hexahedron of second order (20 nodes)"},
                                  {18, "a prism of second order (15 nodes)"},
                                  {19, "a pyramid of second order (13 nodes)"},
                                  {29, "a tetrahedron of third order (20 nodes)"},
                                  {30, "a tetrahedron of fourth order (35 nodes)"},
                                  {31, "a tetrahedron of fifth order (56 nodes)"},
                                  {35, "a polyhedron"}};

}  // namespace

GmshCell gmshCell(int type)
{
    if (type == 4) return {CellKind::tet, 4, {}};
    if (type == 15) return {CellKind::point, 1, {}};
    for (const Counted& line : kLines)
        if (line.type == type) return {CellKind::edge, line.nodes, {}};
    for (const Counted& face : kFaces)
        if (face.type == type) return {CellKind::face, face.nodes, {}};
    for (const NamedCell& volume : kVolumes)
        if (volume.type == type)
            return {CellKind::refused, 0, message(volume.name, ", Gmsh's element type ", type, ",")};
    return {CellKind::refused, 0, message("Gmsh's element type ", type)};
}

}  // namespace bullet_fem
