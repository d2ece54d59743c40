// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Scenes in motion, against closed formulas.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tools/scene/scene_frames.h"
#include "tools/scene_run.h"
#include "tools/scene_samples.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;
using testing::StartsWith;

// A cantilever under its own weight: w L^4 / (8 E I) by Euler and Bernoulli, and w L^2 / (2 k G A) of shear by
// Timoshenko, k = 5/6. It bends by 0.4 % of its length, so that beam theory is linear. Linear tetrahedra are too stiff
// in bending by an error of second order in their size, so that two meshes give the limit.
double tipDeflection(double cell)
{
    SceneRun run(R"({ "step": 0.02, "softBodies": [{ "name": "beam", "mesh": { "box": [1, 0.2, 0.2], "cell": )" +
                 std::to_string(cell) +
                 R"( }, "material": { "young": 1e8, "poisson": 0, "density": 1000, "stiffnessDamping": 0.1 },
              "pins": [{ "low": [-0.51, -1, -1], "high": [-0.49, 1, 1] }] }] })");
    const std::vector<int> tip = run.nodesIn(0, {{0.49, -1, -1}, {0.51, 1, 1}});
    const std::vector<int> clamp = run.nodesIn(0, {{-0.51, -1, -1}, {-0.49, 1, 1}});
    std::vector<Vec3> before;
    for (const int i : clamp) before.push_back(run.node(0, i));
    run.until(1.5);
    for (std::size_t i = 0; i < clamp.size(); ++i) EXPECT_EQ(norm(run.node(0, clamp[i]) - before[i]), 0) << "pinned";
    double sum = 0;
    for (const int i : tip) sum -= run.node(0, i).y;
    return sum / double(tip.size());
}

TEST(SceneWorld, ABeamBendsAsBeamTheorySays)
{
    const double E = 1e8, G = E / 2, L = 1, A = 0.2 * 0.2, I = std::pow(0.2, 4) / 12, w = 1000 * 9.81 * A;
    const double theory = w * std::pow(L, 4) / (8 * E * I) + w * L * L / (2 * 5. / 6 * G * A);
    const double coarse = tipDeflection(0.05), fine = tipDeflection(0.025);
    RecordProperty("coarse", std::to_string(coarse / theory));
    RecordProperty("fine", std::to_string(fine / theory));
    EXPECT_NEAR(fine / theory, 1, 0.06);
    EXPECT_LT(coarse, fine);
    EXPECT_NEAR((4 * fine - coarse) / 3 / theory, 1, 0.015) << "extrapolated to small elements";
}

TEST(SceneWorld, TheShortestStepMovesABody)
{
    SceneRun run(R"({ "step": 1e-6, "softBodies": [{ "name": "cube", "mesh": { "box": [1, 1, 1], "tets": 40 } }] })");
    run.m_world.step();
    EXPECT_EQ(run.m_world.fem().stepReport(&run.m_world.soft(0)).m_flags, 0);
    EXPECT_NEAR(norm(run.momentum(0)) / (1000 * 9.81 * 1e-6), 1, 1e-4);
}

TEST(SceneWorld, APressedBlockPushesBackByItsStiffness)
{
    SceneRun run(R"({ "gravity": [0, 0, 0], "step": 0.01, "solver": { "tolerance": 1e-5 },
      "softBodies": [{ "name": "block", "mesh": { "box": [0.4, 0.4, 0.5], "tets": 600 }, "position": [0, 0.2, 0], "friction": 0,
        "material": { "young": 1e5, "poisson": 0, "density": 40, "stiffnessDamping": 0.0001 } }],
      "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } },
        { "name": "plate", "shape": { "box": [0.7, 0.06, 0.7] }, "position": [0, 0.43, 0], "velocity": [0, -0.05, 0] }] })");
    run.until(0.4);
    const btRigidBody& plate = run.m_world.rigid(1);
    EXPECT_NEAR(plate.getWorldTransform().getOrigin().y(), 0.43 - 0.05 * 0.4, 1e-5) << "speed by time";
    double top = 0;
    for (int i = 0; i < run.nodeCount(0); ++i) top = std::max(top, run.node(0, i).y);
    EXPECT_NEAR(top, 0.38, 2e-4);
    const double strain = 0.02 / 0.4, expected = 1e5 * 0.4 * 0.5 * strain;  // E A strain
    const btSoftBody& block = run.m_world.soft(0);
    EXPECT_NEAR(run.m_world.fem().contactForce(&block, &plate).y(), -expected, 0.03 * expected);
    EXPECT_NEAR(run.m_world.fem().contactForce(&block, &run.m_world.rigid(0)).y(), expected, 0.03 * expected);
}

// A scene's axes are those of the mesh: the body's rotation turns its fibres upright.
TEST(SceneWorld, AnOrthotropicBlockPushesBackByItsFibres)
{
    SceneRun run(R"({ "gravity": [0, 0, 0], "step": 0.01, "solver": { "tolerance": 1e-5 },
      "softBodies": [{ "name": "block", "mesh": { "box": [0.4, 0.4, 0.5], "tets": 600 }, "position": [0, 0.2, 0], "friction": 0,
        "rotation": { "axis": [0, 0, 1], "degrees": 90 },
        "material": { "density": 40, "stiffnessDamping": 0.0001,
          "orthotropic": { "young": [1e5, 1e4, 2e4], "poisson": [0, 0, 0], "shear": [2e4, 2e4, 5e3] } } }],
      "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } },
        { "name": "plate", "shape": { "box": [0.7, 0.06, 0.7] }, "position": [0, 0.43, 0], "velocity": [0, -0.05, 0] }] })");
    run.until(0.4);
    const double expected = 1e5 * 0.4 * 0.5 * 0.02 / 0.4;  // E1 A strain
    const btSoftBody& block = run.m_world.soft(0);
    EXPECT_NEAR(run.m_world.fem().contactForce(&block, &run.m_world.rigid(1)).y(), -expected, 0.03 * expected);
    EXPECT_NEAR(run.m_world.materials(0).first().m_orthotropic.m_along.y, 1, 1e-6);
}

// A block two cells across under uniform load needs no bending; its stiffness along the fibres stays.
TEST(SceneWorld, BlocksOfEveryLawPushBackWithAccurateBending)
{
    for (const std::string law :
         {R"("young": 1e5, "poisson": 0, "law": "neoHooke")",
          R"("young": 1e5, "poisson": 0, "law": "damage", "lawConstants": { "strength": 1e5 })",
          R"("orthotropic": { "young": [2e4, 1e5, 2e4], "poisson": [0, 0, 0], "shear": [2e4, 2e4, 5e3] })"})
    {
        SceneRun run(R"({ "gravity": [0, 0, 0], "step": 0.01, "solver": { "tolerance": 1e-5 },
          "softBodies": [{ "name": "block", "mesh": { "box": [0.4, 0.4, 0.5], "tets": 40 }, "position": [0, 0.2, 0],
            "friction": 0, "material": { "bending": "accurate", "density": 40, "stiffnessDamping": 0.0001, )" +
                     law + R"( } }],
          "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } },
            { "name": "plate", "shape": { "box": [0.7, 0.06, 0.7] }, "position": [0, 0.43, 0], "velocity": [0, -0.01, 0] }] })");
        run.until(0.4);
        EXPECT_EQ(run.m_world.materials(0).first().m_bending, Bending::accurate);
        const double expected = 1e5 * 0.4 * 0.5 * 0.004 / 0.4;  // E A strain
        const btSoftBody& block = run.m_world.soft(0);
        EXPECT_NEAR(run.m_world.fem().contactForce(&block, &run.m_world.rigid(1)).y(), -expected, 0.04 * expected)
            << law;
    }
}

TEST(SceneWorld, AnchorsFollowTheirObjects)
{
    SceneRun run(
        R"({ "softBodies": [{ "name": "block", "mesh": { "box": [0.2, 0.2, 0.2], "tets": 300 }, "material": "rubber" }],
      "rigidBodies": [{ "name": "hook", "shape": { "box": [0.2, 0.2, 0.2] }, "position": [0, 0.5, 0], "velocity": [0.1, 0, 0] }],
      "constraints": [{ "kind": "anchor", "soft": "block", "rigid": "hook",
        "nodes": { "low": [-1, 0.09, -1], "high": [1, 1, 1] } }] })");
    const std::vector<int> held = run.nodesIn(0, {{-1, 0.09, -1}, {1, 1, 1}});
    ASSERT_GE(held.size(), 9u);
    std::vector<Vec3> before;
    for (const int i : held) before.push_back(run.node(0, i));
    run.until(1);
    for (std::size_t i = 0; i < held.size(); ++i)
        EXPECT_NEAR(norm(run.node(0, held[i]) - before[i] - Vec3{0.1, 0, 0}), 0, 1e-4);
    for (int i = 0; i < run.nodeCount(0); ++i) EXPECT_GT(run.node(0, i).y, -0.11) << "hangs";
}

// A free motor of torque T accelerates a body of inertia I to T t / I, up to its speed; right-handed about the axis.
TEST(SceneWorld, AHingeTurnsByItsMotor)
{
    const std::string scene = R"({ "gravity": [0, 0, 0], "step": 0.01,
      "rigidBodies": [{ "name": "arm", "shape": { "box": [0.6, 0.3, 0.3] }, "mass": 2 }],
      "constraints": [{ "kind": "hinge", "body": "arm", "pivot": [0, 0, 0], "axis": [0, 0, 3], "speed": 2, "torque": )";
    const double inertia = 2. / 12 * (0.36 + 0.09);
    SceneRun weak(scene + "0.05 }] }");
    weak.until(0.5);
    EXPECT_NEAR(weak.m_world.rigid(0).getAngularVelocity().z(), 0.05 * 0.5 / inertia, 0.01 * 0.05 * 0.5 / inertia);
    SceneRun strong(scene + "50 }] }");
    strong.until(0.5);
    EXPECT_NEAR(strong.m_world.rigid(0).getAngularVelocity().z(), 2, 1e-3);
    EXPECT_NEAR(norm(vec3(strong.m_world.rigid(0).getWorldTransform().getOrigin())), 0, 1e-4);
}

// A pendulum, a point mass at 1 m: its distance from the pivot is constant.
TEST(SceneWorld, APointHoldsItsPivot)
{
    SceneRun run(
        R"({ "step": 0.005, "rigidBodies": [{ "name": "bob", "shape": { "sphere": 0.1 }, "mass": 1, "position": [1, 0, 0] },
      { "name": "post", "shape": { "box": [0.1, 0.1, 0.1] }, "position": [0, 0, 5] }],
      "constraints": [{ "kind": "point", "body": "bob", "to": "post", "pivot": [0, 0, 0] }] })");
    double lowest = 0;
    for (int k = 0; k < 200; ++k)
    {
        run.m_world.step();
        const btVector3 x = run.m_world.rigid(0).getWorldTransform().getOrigin();
        EXPECT_NEAR(x.length(), 1, 0.02);
        lowest = std::min<double>(lowest, x.y());
    }
    EXPECT_LT(lowest, -0.9);
}

TEST(SceneWorld, AForceActsInItsTimeAlone)
{
    SceneRun run(R"({ "gravity": [0, 0, 0], "step": 0.01,
      "softBodies": [{ "name": "soft", "mesh": { "box": [0.2, 0.2, 0.2], "tets": 100 }, "material": { "density": 1000 } }],
      "rigidBodies": [{ "name": "rigid", "shape": { "sphere": 0.1 }, "mass": 2, "position": [0, 2, 0] }],
      "forces": [{ "body": "soft", "force": [10, 0, 0], "from": 0.2, "to": 0.5 },
        { "body": "rigid", "force": [0, 4, 0], "from": 0.1, "to": 0.3 }] })");
    run.until(0.2);
    EXPECT_LT(norm(run.momentum(0)), 1e-12);
    run.until(0.21);
    for (int i = 0; i < run.nodeCount(0); ++i)  // distributed by mass, it accelerates all nodes equally
        EXPECT_NEAR(norm(vec3(run.m_world.soft(0).m_nodes[i].m_v) - Vec3{0.1 / 8, 0, 0}), 0, 1e-6);
    run.until(0.35);
    EXPECT_NEAR(run.momentum(0).x, 10 * 0.15, 1e-3 * 1.5);
    run.until(1);
    EXPECT_NEAR(norm(run.momentum(0) - Vec3{3, 0, 0}), 0, 3e-3);
    EXPECT_NEAR(run.m_world.rigid(0).getLinearVelocity().y(), 4 * 0.2 / 2, 1e-3);
}

// Nodes that leave the box of the force stay under the force.
TEST(SceneWorld, ForceStaysWithTheNodesOfItsInitialBox)
{
    SceneRun run(R"({ "gravity": [0, 0, 0], "step": 0.01,
      "softBodies": [{ "name": "soft", "mesh": { "box": [0.2, 0.2, 0.2], "tets": 300 }, "material": "rubber" }],
      "forces": [{ "body": "soft", "force": [50, 0, 0], "nodes": { "low": [0.099, -1, -1], "high": [0.101, 1, 1] } }] })");
    run.until(0.5);
    EXPECT_NEAR(run.momentum(0).x, 50 * 0.5, 1e-2);
    for (int i = 0; i < run.nodeCount(0); ++i) EXPECT_GT(run.node(0, i).x, 0.2) << "all have left the box";
}

TEST(SceneWorld, ABakedBodyFallsWithItsOwnMass)
{
    const TemporaryFolder folder;
    writeSampleMeshes(folder);
    SceneRun run(
        R"({ "step": 0.01, "softBodies": [{ "name": "b", "mesh": { "baked": "body.bfem" }, "position": [3, 0, 0],
        "rotation": { "axis": [0, 0, 1], "degrees": 90 }, "velocity": [0, 0, 1] }] })",
        folder.path(""));
    EXPECT_NEAR(run.m_world.soft(0).getTotalMass(), 1000, 0.1) << "a cubic metre of 1000 kg/m3";
    const Vec3 corner = run.node(0, 0);
    EXPECT_NEAR(norm(corner - Vec3{3, 0, 0}), 0, 1e-5);
    EXPECT_NEAR(norm(run.node(0, 1) - Vec3{3, 0.5, 0}), 0, 1e-5) << "x has turned to y";
    run.until(0.5);
    const double fall = 9.81 * 0.01 * 0.01 * 50 * 50 / 2;
    EXPECT_NEAR(norm(run.node(0, 0) - corner - Vec3{0, -fall, 0.5}), 0, 1e-4);
}

// Layers of a cube of 1 m: the lower one is compressed by the weight of the upper one, without lateral strains.
TEST(SceneWorld, RegionsOfAFileHaveMaterialsOfTheirOwn)
{
    const TemporaryFolder folder;
    writeSampleMeshes(folder);
    SceneRun run(R"({ "step": 0.01, "softBodies": [{ "name": "layers", "mesh": { "tetrahedra": "regions.msh" },
      "friction": 0, "materials": {
        "1": { "young": 4e5, "poisson": 0, "density": 1000, "stiffnessDamping": 0.1 },
        "-2": { "young": 1e8, "poisson": 0, "density": 3000, "stiffnessDamping": 0.1 } } }],
      "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }] })",
                 folder.path(""));
    const std::vector<int> foot = run.nodesIn(0, {{-1, -0.1, -1}, {2, 0.1, 2}}),
                           middle = run.nodesIn(0, {{-1, 0.4, -1}, {2, 0.6, 2}});
    EXPECT_NEAR(run.m_world.soft(0).getTotalMass(), 2000, 0.01);
    ASSERT_EQ(run.m_world.regionLabels(0).size(), 40u);
    EXPECT_EQ(run.m_world.materials(0).m_regions.size(), 2u);
    run.until(3);
    const double height = run.node(0, middle[0]).y - run.node(0, foot[0]).y;
    const double squeezed = 0.5 / 4e5 * 9.81 * (3000 * 0.5 + 1000 * 0.25);
    EXPECT_NEAR(0.5 - height, squeezed, 0.02 * squeezed);
    SceneFrames frames(run.m_world);
    EXPECT_EQ(frames.volumes()[0].m_tetRegion, run.m_world.regionLabels(0));
}

TEST(SceneWorld, MeshesHaveTheRequestedSizesAndElements)
{
    const TemporaryFolder folder;
    writeSampleMeshes(folder);
    const auto countOf = [&](const std::string& mesh)
    {
        SceneRun run(R"({ "softBodies": [{ "name": "b", "mesh": { )" + mesh + " } }] }", folder.path(""));
        return run.m_world.soft(0).m_tetras.size();
    };
    EXPECT_EQ(countOf(R"("box": [1, 1, 1], "cell": 0.25)"), 5 * 64);
    EXPECT_EQ(countOf(R"("box": [1, 1, 1], "cell": 0.25, "scale": 0.5)"), 5 * 8) << "the cell is in metres";
    EXPECT_NEAR(countOf(R"("box": [1, 1, 1], "tets": 2000)"), 2000, 600);
    EXPECT_NEAR(countOf(R"("box": [20, 0.02, 0.02], "tets": 500)"), 500, 50) << "thin: one cell across";
    EXPECT_EQ(countOf(R"("sphere": 0.4, "cell": 0.1)"), 6 * 512);
    EXPECT_EQ(countOf(R"("sphere": 0.4, "cell": 0.1, "scale": 0.5)"), 6 * 64);
    EXPECT_NEAR(countOf(R"("sphere": 0.4, "tets": 2000)"), 2000, 600);
    EXPECT_EQ(countOf(R"("surface": "cube.off", "cell": 0.5)"), 5 * 8);
    EXPECT_EQ(countOf(R"("surface": "cube.off", "cell": 0.5, "grade": 4, "levels": 2)"), 6 * 64);
    SceneRun scan(R"({ "softBodies": [{ "name": "b", "mesh": { "surface": "cube.off", "tets": 600, "scale": 0.5 },
        "material": { "density": 800 } }, { "name": "t", "mesh": { "tetrahedra": "two.node", "scale": 2 }, "position": [9, 0, 0] }] })",
                  folder.path(""));
    EXPECT_NEAR(scan.m_world.soft(0).m_tetras.size(), 600, 300);
    EXPECT_NEAR(scan.m_world.soft(0).getTotalMass(), 800 * 0.125, 0.5);
    EXPECT_NEAR(scan.m_world.soft(1).getTotalMass(), 1000 * 8, 8);
}

// A ball that falls .2 m reaches 2 m/s, and half of it after the bounce.
TEST(SceneWorld, ASoftBallBouncesByItsRestitution)
{
    for (const double restitution : {0.0, 0.5})
    {
        SceneRun run(R"({ "step": 0.005,
          "softBodies": [{ "name": "ball", "mesh": { "sphere": 0.1, "cell": 0.05 }, "position": [0, 0.3, 0],
            "material": { "young": 1e7, "stiffnessDamping": 0.02 }, "restitution": )" +
                     std::to_string(restitution) + R"( }],
          "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] }, "restitution": 1 }] })");
        double highest = 0, mass = 0;
        for (int i = 0; i < run.nodeCount(0); ++i) mass += 1 / double(run.m_world.soft(0).m_nodes[i].m_im);
        run.until(0.22);  // contact with the ground after .202 s
        for (; run.m_world.time() < 0.5; run.m_world.step()) highest = std::max(highest, run.momentum(0).y / mass);
        EXPECT_NEAR(highest, 2 * restitution, 0.2) << restitution;
    }
}

TEST(SceneWorld, ASceneGivesTheSameBitsAgain)
{
    const auto run = []
    {
        const auto scene = std::make_unique<SceneRun>(
            R"({ "softBodies": [{ "name": "a", "mesh": { "box": [0.2, 0.2, 0.2], "tets": 300 }, "position": [0, 0.15, 0] }],
              "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } },
                { "name": "ball", "shape": { "sphere": 0.1 }, "mass": 3, "position": [0.03, 0.5, 0] }] })");
        scene->until(0.5);
        std::vector<double> numbers;
        for (int i = 0; i < scene->nodeCount(0); ++i)
            for (int c = 0; c < 3; ++c) numbers.push_back(scene->node(0, i)[c]);
        return numbers;
    };
    EXPECT_EQ(run(), run());
}

// Errors that the reader cannot detect are reported when the world is made, after other bodies were added to it.
std::string refusal(const std::string& softMember, const std::string& more, const std::string& folder = ".")
{
    const std::string text = R"({ "softBodies": [{ "name": "first", "mesh": { "box": [1, 1, 1], "tets": 40 } },
        { "name": "pad", )" + softMember +
                             R"( }], "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } },
        { "name": "ball", "shape": { "sphere": 0.1 }, "mass": 3, "position": [0, 3, 0] }])" +
                             more + "}";
    return messageOf<std::exception>([&] { SceneRun(text, folder); });
}

TEST(SceneWorld, InvalidBodiesAreRejectedByName)
{
    const std::string mesh = R"("mesh": { "box": [1, 1, 1], "tets": 40 })";
    EXPECT_EQ(refusal(mesh + R"(, "pins": [{ "low": [5, 5, 5], "high": [6, 6, 6] }])", ""),
              "'pad': a box of its pins holds no node at the start; move or enlarge it");
    EXPECT_EQ(refusal(mesh, R"(, "constraints": [{ "kind": "anchor", "soft": "pad", "rigid": "ball",
        "nodes": { "low": [5, 5, 5], "high": [6, 6, 6] } }])"),
              "'pad': the box of its anchors to 'ball' holds no node at the start; move or enlarge it");
    EXPECT_EQ(refusal(mesh, R"(, "forces": [{ "body": "pad", "force": [1, 0, 0],
        "nodes": { "low": [5, 5, 5], "high": [6, 6, 6] } }])"),
              "'pad': the box of a force holds no free node at the start; move or enlarge it");
    EXPECT_THAT(refusal(R"("mesh": { "box": [1, 1, 1], "cell": 1e-5 })", ""), StartsWith("'pad': "));
    EXPECT_THAT(refusal(R"("mesh": { "box": [1, 1, 1], "cell": 1e-5 })", ""),
                HasSubstr("cell count along x is 100000, outside [1, 1000]"));
    const TemporaryFolder folder;
    folder.write("bad.off", "OFF\n3 1 0\n0 0 0\n");
    folder.write("bad.bfem", "no body");
    folder.write("open.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    for (const char* member : {R"("surface": "bad.off")", R"("tetrahedra": "bad.off")", R"("baked": "bad.bfem")"})
        EXPECT_THAT(refusal(std::string("\"mesh\": {") + member + "}", "", folder.path("")),
                    testing::AllOf(StartsWith("'pad': "), HasSubstr(folder.path("")), HasSubstr("bad.")))
            << member;
    EXPECT_THAT(refusal(R"("mesh": { "surface": "open.off" })", "", folder.path("")), StartsWith("'pad': "));
    const TemporaryFolder meshes;
    writeSampleMeshes(meshes);
    const auto regions = [&](const std::string& file, const std::string& materials) {
        return refusal("\"mesh\": { \"tetrahedra\": \"" + file + "\" }, \"materials\": " + materials, "",
                       meshes.path(""));
    };
    EXPECT_THAT(regions("two.node", R"({ "1": "foam" })"),
                "'pad': its file has no regions and is not painted; give it one material");
    EXPECT_THAT(regions("regions.msh", R"({ "1": "foam", "5": "wood" })"),
                testing::AllOf(StartsWith("'pad': region -2"), HasSubstr("for the regions: 1, 5")));
    EXPECT_THAT(regions("regions.msh", R"({ "1": "foam", "-2": { "stiffnessDamping": 0.1 } })"),
                testing::AllOf(StartsWith("'pad': the stiffness damping"), HasSubstr("give all its regions the same")));
}

}  // namespace
}  // namespace bullet_fem
