// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string_view>

#include "bullet_fem/io/tet_mesh_file.h"
#include "io/tet/mesh_scanner.h"

namespace bullet_fem
{

// Each reader throws std::runtime_error with place and cause; the caller puts the file's name before it. All nodes of
// the file are still there, and positions may not be finite.

TetMeshFile readGmsh(std::string_view bytes);
TetMeshFile readVtk(std::string_view bytes);
TetMeshFile readVtu(std::string_view bytes);
TetMeshFile readMedit(std::string_view bytes);

/// The text of a .node file, comments excepted: sets positions and numbers.
void readTetGenNodes(MeshScanner& text, TetMeshFile& mesh);
/// The text of an .ele file, for the nodes that are there already.
void readTetGenTets(MeshScanner& text, TetMeshFile& mesh);

}  // namespace bullet_fem
