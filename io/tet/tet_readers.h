// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string_view>

#include "bullet_fem/io/tet_mesh_file.h"
#include "io/tet/mesh_scanner.h"

namespace bullet_fem
{

// Each reader throws std::runtime_error with position and cause; the caller prepends the file's name. All nodes of the
// file are kept, and positions may not be finite.

TetMeshFile readGmsh(std::string_view bytes);
TetMeshFile readVtk(std::string_view bytes);
TetMeshFile readVtu(std::string_view bytes);
TetMeshFile readMedit(std::string_view bytes);

/// Reads the text of a .node file, without comments: sets positions and numbers.
void readTetGenNodes(MeshScanner& text, TetMeshFile& mesh);
/// Reads the text of an .ele file, after the nodes.
void readTetGenTets(MeshScanner& text, TetMeshFile& mesh);

}  // namespace bullet_fem
