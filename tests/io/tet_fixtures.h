// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "bullet_fem/io/tet_mesh_file.h"

namespace bullet_fem
{

/// A hand-made file of a common mesh: two tetrahedra on five nodes, and a sixth node that only a triangle uses. Without
/// GoogleTest, so that fuzzers can use it as a seed.
struct TetFixture
{
    std::string name;  ///< letters and digits
    TetMeshFormat format;
    std::string bytes;
    std::size_t faces = 1, edges = 1, points = 1;  ///< numbers of skipped elements
    std::string version;                           ///< expected value of m_version
};

inline std::ostream& operator<<(std::ostream& out, const TetFixture& fixture)
{
    return out << fixture.name;
}

/// The common nodes of all files, in order; node 3 belongs to no tetrahedron. Exact in single precision.
const std::vector<Vec3>& fixtureNodes();
/// The common tetrahedra of all files, by index into fixtureNodes().
const std::vector<Tet>& fixtureTets();

/// Fixtures of all supported formats, versions, encodings, byte orders and layouts.
std::vector<TetFixture> tetFixtures();

/// Gmsh version 1, with the section of nodes called $NOD or $NOE.
std::string gmsh1Text(const std::string& nodes);
std::string gmsh2Text(const std::string& version);
std::string gmsh4Text();
std::string tetGenText(int first);
std::string vtkText(const std::string& version);
std::string vtuText();
std::string meditText(int version);

/// The layout of arrays in a .vtu file.
struct VtuLayout
{
    const char* format = "binary";  ///< or "raw" or "base64", for appended data
    bool bigEndian = false;
    int headerBytes = 4;
    std::size_t blockBytes = 0;  ///< size of zlib's blocks; 0 for no compression
    bool paddedHeader = false;   ///< base64 of an uncompressed array's byte count, padded by itself
    const char* real = "Float64";
    const char* integer = "Int64";
};
std::string vtuBinary(const VtuLayout& layout);

}  // namespace bullet_fem
