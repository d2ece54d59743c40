// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <map>
#include <memory>

#include "bullet_fem/io/tet_mesh_file.h"
#include "io/tet/mesh_scanner.h"
#include "io/tet/node_numbers.h"

namespace bullet_fem
{

/// State for reading the sections of a .msh file.
struct GmshFile
{
    MeshScanner scanner;
    TetMeshFile mesh;
    int sizeBytes = 8;                            ///< size of version 4's size_t in binary files
    std::unique_ptr<NodeNumbers> numbers;         ///< set after the nodes were read
    std::map<std::int32_t, std::int32_t> groups;  ///< version 4: first physical group of each volume
};

// Read the contents of $Nodes and $Elements ($NOD and $ELM in version 1), up to the closing line.
void readGmshElements1(GmshFile& file);
void readGmshNodes2(GmshFile& file);  // also version 1
void readGmshElements2(GmshFile& file);
void readGmshNodes4(GmshFile& file);
void readGmshElements4(GmshFile& file);
/// Reads the contents of $Entities in version 4.1, up to the closing line.
void readGmshEntities4(GmshFile& file);

/// A node's position, the next three numbers.
Vec3 readGmshPosition(MeshScanner& scanner);
/// The index of the node with this tag; fails if there is none.
int placeOfGmshNode(const GmshFile& file, std::uint64_t tag);

}  // namespace bullet_fem
