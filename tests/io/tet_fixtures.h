// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "bullet_fem/io/tet_mesh_file.h"

namespace bullet_fem
{

/// A file, made by hand, of one and the same mesh: two tetrahedra on five nodes, and a sixth node that only a triangle
/// uses. Without GoogleTest, so that fuzzers can begin with it.
struct TetFixture
{
    std::string name;  ///< letters and digits
    TetMeshFormat format;
    std::string bytes;
    std::size_t faces = 1, edges = 1, points = 1;  ///< that are skipped
    std::string version;                           ///< what m_version must be
};

inline std::ostream& operator<<(std::ostream& out, const TetFixture& fixture)
{
    return out << fixture.name;
}

/// The nodes that all the files have, in their order; number 3 is the one without tetrahedra. Exact in single
/// precision.
const std::vector<Vec3>& fixtureNodes();
/// The tetrahedra that all the files have, by places in fixtureNodes().
const std::vector<Tet>& fixtureTets();

/// Every format, version, encoding, byte order and layout that is read.
std::vector<TetFixture> tetFixtures();

/// Version 1, whose section of nodes is $NOD or $NOE.
std::string gmsh1Text(const std::string& nodes);
std::string gmsh2Text(const std::string& version);
std::string gmsh4Text();
std::string tetGenText(int first);
std::string vtkText(const std::string& version);
std::string vtuText();
std::string meditText(int version);

/// How a .vtu file holds its arrays.
struct VtuLayout
{
    const char* format = "binary";  ///< or "raw" or "base64", of appended data
    bool bigEndian = false;
    int headerBytes = 4;
    std::size_t blockBytes = 0;  ///< of zlib's blocks; 0 for no compression
    bool paddedHeader = false;   ///< base64 of an uncompressed array's count by itself
    const char* real = "Float64";
    const char* integer = "Int64";
};
std::string vtuBinary(const VtuLayout& layout);

}  // namespace bullet_fem
