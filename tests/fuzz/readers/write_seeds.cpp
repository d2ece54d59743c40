// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors

// Writes the fuzzers' seed files: a folder per reader, a file per fixture.
#include <filesystem>
#include <fstream>

#include "io/tet_fixtures.h"

namespace
{

void write(const std::filesystem::path& folder, const std::string& name, const std::string& bytes)
{
    std::filesystem::create_directories(folder);
    std::ofstream(folder / name, std::ios::binary) << bytes;
}

const char* nameOf(bullet_fem::TetMeshFormat format)
{
    constexpr const char* names[] = {"gmsh", "tetgen", "vtk", "vtu", "medit"};
    return names[static_cast<int>(format)];
}

}  // namespace

int main(int argumentCount, char** arguments)
{
    if (argumentCount != 2) return 2;
    const std::filesystem::path seeds = arguments[1];
    for (const bullet_fem::TetFixture& fixture : bullet_fem::tetFixtures())
        write(seeds / nameOf(fixture.format), fixture.name, fixture.bytes);

    write(seeds / "off", "tetrahedron", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
    write(seeds / "off", "coloured",
          "# red\nCOFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n3 0 1 2 255 0 0");
    const std::string header =
        " 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty double z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";
    const std::string zeros(3 * 16, '\0'), face("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13),
        bigFace("\3\0\0\0\0\0\0\0\1\0\0\0\2", 13);
    write(seeds / "ply", "text", "ply\nformat ascii" + header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    write(seeds / "ply", "little", "ply\nformat binary_little_endian" + header + zeros + face);
    write(seeds / "ply", "big", "ply\nformat binary_big_endian" + header + zeros + bigFace);
    return 0;
}
