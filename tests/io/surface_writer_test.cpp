// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/surface_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "bullet_fem/io/colour_map.h"
#include "bullet_fem/io/surface_file.h"
#include "io/sample_bodies.h"
#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;
using testing::Not;

const std::vector<BodyFrame>& sampleBodies()
{
    static const std::vector<BodyFrame> bodies = {sampleBox(0, 0.5), sampleTriangle(7), sampleBox(2)};
    return bodies;
}

// Checks the surfaces that were read back: 26 + 3 + 26 vertices, 48 + 1 + 48 triangles, the boxes' volumes.
void expectSampleSurface(const SurfaceMesh& mesh)
{
    ASSERT_EQ(mesh.m_vertices.size(), 55u);
    ASSERT_EQ(mesh.m_triangles.size(), 97u);
    EXPECT_NEAR(norm(mesh.m_vertices[25] - sampleBodies()[0].m_positions[26]), 0, 1e-6);
    EXPECT_NEAR(norm(mesh.m_vertices[54] - sampleBodies()[2].m_positions[26]), 0, 1e-6);
    double volume = 0;
    for (const Triangle& t : mesh.m_triangles)
        volume += dot(mesh.m_vertices[t[0]], cross(mesh.m_vertices[t[1]], mesh.m_vertices[t[2]])) / 6;
    EXPECT_NEAR(volume, 1.125 + 1, 1e-5);  // the first is stretched by an eighth; the triangle's plane holds the origin
}

TEST(SurfaceWriter, ObjIsReadBack)
{
    const TemporaryFolder folder;
    writeObj(folder.path("frame.obj"), sampleBodies());
    expectSampleSurface(readSurfaceFile(folder.path("frame.obj")));
    const std::string text = folder.read("frame.obj");
    for (const char* object : {"\no body_0\nv ", "\no body_7\nv -1 -1 0\n", "\no body_2\nv "})
        EXPECT_THAT(text, HasSubstr(object));
    EXPECT_THAT(text, HasSubstr("\nf 27 28 29\n"));
}

TEST(SurfaceWriter, PlyIsReadBack)
{
    const TemporaryFolder folder;
    writePly(folder.path("frame.ply"), sampleBodies());
    expectSampleSurface(readSurfaceFile(folder.path("frame.ply")));
}

// A vertex has 3 + 1 floats and 3 colours; a face has a count, 3 indices and the body.
TEST(SurfaceWriter, PlyHasStressColoursAndBodies)
{
    const TemporaryFolder folder;
    writePly(folder.path("frame.ply"), sampleBodies(), 2000);
    const std::string bytes = folder.read("frame.ply");
    const std::size_t begin = bytes.find("end_header\n") + 11;
    ASSERT_EQ(bytes.size(), begin + 55 * 19 + 97 * 17);
    const double stress = vonMises(sampleBodies()[0].m_nodeStress[26]);
    float written;
    std::memcpy(&written, &bytes[begin + 25 * 19 + 12], 4);
    EXPECT_NEAR(written, stress, 1e-3);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(static_cast<unsigned char>(bytes[begin + 25 * 19 + 16 + i]), 255 * viridis(stress / 2000)[i], 0.51);
    std::int32_t body;
    std::memcpy(&body, &bytes[begin + 55 * 19 + 48 * 17 + 13], 4);
    EXPECT_EQ(body, 7);
    EXPECT_THAT(bytes, HasSubstr("property float von_mises\nproperty uchar red\n"));
}

TEST(SurfaceWriter, PlyWithoutStressHasNoColours)
{
    const TemporaryFolder folder;
    writePly(folder.path("frame.ply"), {sampleTriangle(1)});
    EXPECT_THAT(folder.read("frame.ply"), Not(HasSubstr("red")));
    BodyFrame cold = sampleTriangle(1);
    cold.m_nodeStress.resize(3);
    writePly(folder.path("frame.ply"), {cold});
    EXPECT_THAT(folder.read("frame.ply"), HasSubstr("red"));
}

TEST(SurfaceWriter, RejectsInvalidBodiesAndPaths)
{
    const TemporaryFolder folder;
    const std::string path = folder.path("frame");
    BodyFrame body = sampleTriangle(3);
    body.m_triangles[0][1] = 3;
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { writeObj(path, {body}); }),
                HasSubstr("writeObj: body 0: triangle 0 uses vertex 3"));
    body.m_triangles.clear();
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { writePly(path, {body}); }), HasSubstr("body 3 has no triangle"));
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { writePly(path, sampleBodies(), NAN); }), HasSubstr("nan Pa"));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { writeObj(folder.path("missing/a.obj"), sampleBodies()); }),
                HasSubstr("missing/a.obj'"));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { writePly("/dev/full", sampleBodies()); }),
                HasSubstr("No space left"));
    EXPECT_THAT(folder.names(), testing::IsEmpty());
}

}  // namespace
}  // namespace bullet_fem
