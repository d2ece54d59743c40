// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_frames.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/io/vtu_writer.h"
#include "tools/scene/scene_reader.h"
#include "tools/scene_samples.h"

namespace bullet_fem
{
namespace
{

const double kHalfTurn = std::acos(-1.);

/// True if each edge occurs once in each direction: closed and consistently oriented.
bool isClosed(const std::vector<Triangle>& triangles)
{
    std::map<std::pair<int, int>, int> edges;
    for (const Triangle& t : triangles)
        for (int a = 0; a < 3; ++a) ++edges[{t[a], t[(a + 1) % 3]}];
    for (const auto& [edge, count] : edges)
    {
        const auto back = edges.find({edge.second, edge.first});
        if (count != 1 || back == edges.end()) return false;
    }
    return true;
}

// Area of a regular polygon of 32 corners over that of its circle. Round ends are polyhedra of 32 by about 16 faces
// inside the ball: their share is at most 2 % smaller.
const double kPolygon = 32 / (2 * kHalfTurn) * std::sin(2 * kHalfTurn / 32);

struct ShapeVolume
{
    const char* m_shape;
    double m_min, m_max;  // [m3]
};

void PrintTo(const ShapeVolume& shape, std::ostream* out)
{
    *out << shape.m_shape;
}

class RigidSurface : public testing::TestWithParam<ShapeVolume>
{
};

TEST_P(RigidSurface, IsClosedOutwardAndFollowsTheBody)
{
    const std::string shape = GetParam().m_shape;
    const SceneDescription scene = parseScene(R"({ "gravity": [0, 0, 0], "step": 0.01, "rigidBodies": [
            { "name": "ground", "shape": { "plane": [0, 0, 1] }, "position": [0, 0, -50] },
            { "name": "a", "mass": 1, "velocity": [1, 0, 0], "position": [0, 2, 0],
              "rotation": { "axis": [1, 2, 3], "degrees": 70 }, "shape": )" +
                                                  shape + " }] }",
                                              ".");
    SceneWorld world(scene);
    SceneFrames frames(world);
    ASSERT_EQ(frames.surfaces().size(), 1u) << "a plane has none";
    EXPECT_EQ(frames.bodyOf(0), 1);
    const std::vector<Triangle> triangles = frames.surfaces()[0].m_triangles;
    EXPECT_TRUE(isClosed(triangles));
    const std::vector<Vec3> before = frames.surfaces()[0].m_positions;
    for (const Triangle& t : triangles)
        EXPECT_GT(norm(cross(before[t[1]] - before[t[0]], before[t[2]] - before[t[0]])), 1e-9)
            << "a triangle of no area";
    const double volume = signedVolume({before, triangles});
    EXPECT_GE(volume, GetParam().m_min * (1 - 1e-5));
    EXPECT_LE(volume, GetParam().m_max * (1 + 1e-5));
    for (int k = 0; k < 50; ++k) world.step();
    frames.update();
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_NEAR(norm(frames.surfaces()[0].m_positions[i] - before[i] - Vec3{0.5, 0, 0}), 0, 1e-4);
}

std::string shapeName(const testing::TestParamInfo<ShapeVolume>& info)
{
    const std::string shape = info.param.m_shape;
    return shape.substr(3, shape.find('"', 3) - 3);
}

INSTANTIATE_TEST_SUITE_P(Shapes, RigidSurface,
                         testing::Values(ShapeVolume{R"({ "box": [1, 2, 3] })", 6, 6},
                                         ShapeVolume{R"({ "sphere": 0.5 })", 0.98 * kPolygon* kHalfTurn / 6,
                                                     kPolygon* kHalfTurn / 6},
                                         ShapeVolume{R"({ "cylinder": { "radius": 0.5, "height": 2 } })",
                                                     kPolygon* kHalfTurn / 2, kPolygon* kHalfTurn / 2},
                                         ShapeVolume{R"({ "capsule": { "radius": 0.5, "height": 2 } })",
                                                     0.98 * kPolygon*(kHalfTurn / 6 + kHalfTurn / 2),
                                                     kPolygon*(kHalfTurn / 6 + kHalfTurn / 2)}),
                         shapeName);

TEST(SceneFrames, AnEmbeddedSurfaceFollowsItsCage)
{
    const TemporaryFolder folder;
    writeSampleMeshes(folder);
    const SceneDescription scene = parseScene(
        R"({ "gravity": [0, 0, 0], "step": 0.01, "softBodies": [{ "name": "a", "mesh": { "surface": "cube.off", "tets": 200 },
          "position": [0, 0, 7], "rotation": { "axis": [0, 0, 1], "degrees": 90 }, "velocity": [0, 0.2, 0] }] })",
        folder.path(""));
    SceneWorld world(scene);
    SceneFrames frames(world);
    ASSERT_EQ(frames.volumes().size(), 1u);
    ASSERT_EQ(frames.surfaces().size(), 1u);
    EXPECT_EQ(frames.bodyOf(0), 0);
    const BodyFrame &volume = frames.volumes()[0], &surface = frames.surfaces()[0];
    EXPECT_GE(volume.m_tets.size(), 100u);
    ASSERT_EQ(surface.m_positions.size(), 8u) << "the file's corners, not the cage's nodes";
    EXPECT_TRUE(isClosed(surface.m_triangles));
    EXPECT_NEAR(signedVolume({surface.m_positions, surface.m_triangles}), 1, 1e-4);
    EXPECT_EQ(surface.m_nodeStress.size(), 8u);
    for (int corner = 0; corner < 8; ++corner)
    {
        const Vec3 turned{corner & 2 ? -1. : 0., corner & 1 ? 1. : 0., corner & 4 ? 8. : 7.};
        EXPECT_NEAR(norm(surface.m_positions[corner] - turned), 0, 1e-4);
    }
    const std::vector<Vec3> before = surface.m_positions;
    for (int k = 0; k < 100; ++k) world.step();
    frames.update();
    for (int corner = 0; corner < 8; ++corner)
        EXPECT_NEAR(norm(surface.m_positions[corner] - before[corner] - Vec3{0, 0.2, 0}), 0, 1e-4);
    for (std::size_t i = 0; i < volume.m_positions.size(); ++i)
    {
        EXPECT_NEAR(norm(volume.m_displacement[i] - Vec3{0, 0.2, 0}), 0, 1e-4);
        EXPECT_NEAR(norm(volume.m_velocity[i] - Vec3{0, 0.2, 0}), 0, 1e-4);
    }
}

TEST(SceneFrames, ContactForcesSumToTheWeightAndStressToTheLoad)
{
    const SceneDescription scene = parseScene(
        R"({ "softBodies": [{ "name": "a", "mesh": { "box": [0.5, 1, 0.4], "cell": 0.125 }, "position": [0, 0.5, 0], "friction": 0,
          "material": { "young": 1e6, "poisson": 0, "density": 1000, "stiffnessDamping": 0.05 } }],
          "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }] })",
        ".");
    SceneWorld world(scene);
    SceneFrames frames(world);
    while (world.time() < 1.5) world.step();
    frames.update();
    const BodyFrame& frame = frames.volumes()[0];
    Vec3 sum;
    for (const Vec3& force : frame.m_contactForce) sum += force;
    const double weight = 200 * 9.81;
    EXPECT_NEAR(norm(sum - Vec3{0, weight, 0}), 0, 1e-3 * weight);
    double load = 0;  // volume-weighted mean of sigma_yy: - rho g H / 2 in a free-standing column
    for (const Stress& stress : frame.m_tetStress) load += stress.yy / double(frame.m_tetStress.size());
    // Elements of a cell differ in size, but hardly in stress.
    EXPECT_NEAR(load, -1000 * 9.81 * 0.5, 0.02 * 1000 * 9.81 * 0.5);
}

// Four by four by four cells: 125 nodes, 98 of them outside.
TEST(SceneFrames, SurfaceHasOnlyOuterVertices)
{
    const SceneDescription scene = parseScene(
        R"({ "softBodies": [{ "name": "a", "mesh": { "box": [1, 1, 1], "cell": 0.25 },
          "pins": [{ "low": [-1, -1, -1], "high": [-0.49, 1, 1] }] }] })",
        ".");
    SceneWorld world(scene);
    SceneFrames frames(world);
    for (int k = 0; k < 5; ++k) world.step();
    frames.update();
    const BodyFrame &volume = frames.volumes()[0], &surface = frames.surfaces()[0];
    EXPECT_EQ(volume.m_positions.size(), 125u);
    ASSERT_EQ(surface.m_positions.size(), 98u);
    ASSERT_EQ(surface.m_nodeStress.size(), 98u);
    EXPECT_TRUE(isClosed(surface.m_triangles));
    std::set<int> seen;
    for (const Triangle& t : surface.m_triangles) seen.insert(t.begin(), t.end());
    EXPECT_EQ(seen.size(), 98u);
    for (std::size_t v = 0; v < 98; ++v)
    {
        const auto& all = volume.m_positions;
        const auto node =
            std::find_if(all.begin(), all.end(), [&](const Vec3& x) { return norm(x - surface.m_positions[v]) == 0; });
        ASSERT_NE(node, all.end()) << v;
        EXPECT_EQ(vonMises(surface.m_nodeStress[v]), vonMises(volume.m_nodeStress[std::size_t(node - all.begin())]));
    }
}

/// The numbers of a text file's cell data.
std::vector<double> cellDataOf(const std::string& xml, const std::string& name)
{
    const std::size_t array = xml.find("Name=\"" + name + "\"", xml.find("<CellData"));
    if (array == std::string::npos) return {};
    std::istringstream stream(xml.substr(xml.find('>', array) + 1));
    return {std::istream_iterator<double>(stream), {}};
}

// The lower half, label 1, yields under the weight of the upper one, label -2, part of which has fibres.
TEST(SceneFrames, ParaViewsFileHasRegionsPlasticStrainAndActivation)
{
    const TemporaryFolder folder;
    writeSampleMeshes(folder);
    const SceneDescription scene = parseScene(
        R"({ "step": 0.01, "softBodies": [{ "name": "layers", "mesh": { "tetrahedra": "regions.msh" },
          "materials": { "1": { "young": 4e5, "poisson": 0.3, "yieldStress": 5e3, "stiffnessDamping": 0.1 },
                         "-2": { "young": 1e7, "poisson": 0.3, "density": 3000, "stiffnessDamping": 0.1 } } }],
          "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }],
          "actuators": [{ "kind": "fibres", "body": "layers", "direction": [1, 0, 0], "activation": 700,
                          "region": { "low": [0, 0.5, 0], "high": [0.5, 1, 1] } }] })",
        folder.path(""));
    SceneWorld world(scene);
    while (world.time() < 0.5) world.step();
    const SceneFrames frames(world);
    VtuSeries(folder.path("out"), "run").writeBodies(world.time(), frames.volumes());
    const std::string xml = folder.read("out/run_000000.vtu");
    const std::vector<double> region = cellDataOf(xml, "region"), strain = cellDataOf(xml, "plastic_strain"),
                              activation = cellDataOf(xml, "activation");
    ASSERT_EQ(region.size(), 40u);
    ASSERT_EQ(strain.size(), 40u);
    ASSERT_EQ(activation.size(), 40u);
    int active = 0;
    for (std::size_t e = 0; e < 40; ++e)
    {
        EXPECT_EQ(region[e], world.regionLabels(0)[e]);
        EXPECT_EQ(strain[e] > 1e-3, region[e] == 1) << strain[e] << " of tetrahedron " << e;
        EXPECT_TRUE(activation[e] == 0 || (activation[e] == 700 && region[e] == -2)) << activation[e];
        active += activation[e] == 700 ? 1 : 0;
    }
    EXPECT_EQ(active, 10) << "two cells of five tetrahedra";
}

// Between two steps soft and rigid bodies are interpolated to one common time.
TEST(SceneFrames, SoftAndRigidBodiesFlyTogetherBetweenSteps)
{
    const SceneDescription scene = parseScene(R"({ "gravity": [0, 0, 0], "step": 0.02,
        "softBodies": [ { "name": "soft", "mesh": { "box": [1, 1, 1], "tets": 60 }, "velocity": [10, 0, 0] } ],
        "rigidBodies": [ { "name": "rigid", "shape": { "box": [1, 1, 1] }, "mass": 1, "position": [1.5, 0, 0],
                           "velocity": [10, 0, 0] } ] })",
                                              ".");
    SceneWorld world(scene);
    for (int k = 0; k < 5; ++k) world.step();
    SceneFrames frames(world);
    const auto foremost = [&](int surface)
    {
        double x = -1e9;
        for (const Vec3& position : frames.surfaces()[surface].m_positions) x = std::max(x, position.x);
        return x;
    };
    const double soft = foremost(0), rigid = foremost(1);
    EXPECT_NEAR(rigid - soft, 1.5, 1e-4);
    frames.update(-0.75);
    EXPECT_NEAR(foremost(0), soft - 0.75 * 0.02 * 10, 1e-4);
    EXPECT_NEAR(foremost(1), rigid - 0.75 * 0.02 * 10, 1e-4);
    frames.update();
    EXPECT_EQ(foremost(0), soft);
    EXPECT_EQ(foremost(1), rigid);
}

TEST(SceneFrames, ReactionForcesOfPinsSumToTheWeight)
{
    const SceneDescription scene = parseScene(
        R"({ "softBodies": [{ "name": "hung", "mesh": { "box": [0.5, 1, 0.5], "cell": 0.25 },
          "material": { "young": 1e6, "density": 1000, "massDamping": 5 },
          "pins": [{ "low": [-1, 0.5, -1], "high": [1, 0.5, 1] }] },
          { "name": "free", "mesh": { "box": [0.5, 1, 0.5], "cell": 0.25 }, "position": [5, 0, 0] }] })",
        ".");
    SceneWorld world(scene);
    SceneFrames frames(world);
    EXPECT_TRUE(frames.volumes()[0].m_reactionForce.empty()) << "before the first step";
    while (world.time() < 4) world.step();
    frames.update();
    ASSERT_EQ(frames.volumes()[0].m_reactionForce.size(), frames.volumes()[0].m_positions.size());
    Vec3 sum;
    for (const Vec3& force : frames.volumes()[0].m_reactionForce) sum += force;
    EXPECT_NEAR(norm(sum - Vec3{0, 250 * 9.81, 0}), 0, 1e-3 * 250 * 9.81);
    EXPECT_TRUE(frames.volumes()[1].m_reactionForce.empty());
}

}  // namespace
}  // namespace bullet_fem
