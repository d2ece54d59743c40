// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "io/tet/cell_kind.h"

namespace bullet_fem
{

/// A Gmsh element type.
struct GmshCell
{
    CellKind kind;
    int nodes;         ///< nodes of an element; 0 if refused
    std::string name;  ///< with its article, if refused
};

/// The element type of a number in Gmsh's list (GmshDefines.h).
GmshCell gmshCell(int type);

}  // namespace bullet_fem
