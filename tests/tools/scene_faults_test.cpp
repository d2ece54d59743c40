// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Detection of inverted bodies and of bodies inside others.
#include "tools/scene/scene_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/scene_run.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;
using testing::IsEmpty;

std::vector<SceneFault> faultsOf(SceneRun& run)
{
    return findFaults(run.m_world, SceneFrames(run.m_world));
}

/// A cube of 1 m at x, y with pins, and another body of 20 cm, which does not move either.
SceneRun cubeAnd(double x, double y, const std::string& other, const std::string& pins = "")
{
    char place[64];
    std::snprintf(place, sizeof place, "[%.17g, %.17g, 0]", x, y);
    return SceneRun(R"({ "softBodies": [{ "name": "cube", "mesh": { "box": [1, 1, 1], "cell": 0.25 },
        "material": "rubber", "position": )" +
                    std::string(place) + pins + " }" + other + " }");
}

const char* const kGround = R"(], "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }])";

TEST(SceneFaults, ABodyOnTheGroundHasNone)
{
    SceneRun run = cubeAnd(0, 0.5, kGround);
    EXPECT_THAT(faultsOf(run), IsEmpty());
    EXPECT_THAT(faultsOf(run.until(0.5)), IsEmpty());
}

TEST(SceneFaults, TellTheDepthBelowThePlane)
{
    SceneRun deep = cubeAnd(0, 0.44, kGround);
    const std::vector<SceneFault> faults = faultsOf(deep);
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0].m_body, "cube");
    EXPECT_EQ(faults[0].m_other, "ground");
    EXPECT_NEAR(faults[0].m_depth, 0.06, 1e-6);
    EXPECT_NEAR(faults[0].m_share, 0.06, 1e-6);
    EXPECT_THAT(faults[0].sentence(), HasSubstr("'cube' is in 'ground', 0.06 m deep (6 % of"));
    SceneRun shallow = cubeAnd(0, 0.46, kGround);
    EXPECT_THAT(faultsOf(shallow), IsEmpty()) << "4 % are allowed";
}

struct FaultShape
{
    const char* m_name;
    const char* m_json;
    double m_depth;  // of the cube's centre; of a small ball's point towards a corner [m]
};

class SceneFaultsOfShapes : public testing::TestWithParam<FaultShape>
{
};

// All shapes have their centre at the origin, as the cube has.
TEST_P(SceneFaultsOfShapes, AreFoundAroundTheOther)
{
    SceneRun run =
        cubeAnd(0, 0, R"(], "rigidBodies": [{ "name": "other", "shape": )" + std::string(GetParam().m_json) + " }]");
    const std::vector<SceneFault> faults = faultsOf(run);
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_NEAR(faults[0].m_depth, GetParam().m_depth, 0.02 * GetParam().m_depth);
}

std::string faultShapeName(const testing::TestParamInfo<FaultShape>& info)
{
    return info.param.m_name;
}

INSTANTIATE_TEST_SUITE_P(
    All, SceneFaultsOfShapes,
    testing::Values(FaultShape{"Box", R"({ "box": [4, 4, 4] })", 2}, FaultShape{"Sphere", R"({ "sphere": 2 })", 2},
                    FaultShape{"Cylinder", R"({ "cylinder": { "radius": 1.5, "height": 8 } })", 1.5},
                    FaultShape{"Capsule", R"({ "capsule": { "radius": 2, "height": 3 } })", 2},
                    FaultShape{"SmallBallInIt", R"({ "sphere": 0.1 })", 0.442}),
    faultShapeName);

TEST(SceneFaults, ASoftBodyInsideASoftOneIsFound)
{
    SceneRun run = cubeAnd(0, 0, R"(, { "name": "seed", "mesh": { "sphere": 0.1, "tets": 100 } }])");
    const std::vector<SceneFault> faults = faultsOf(run);
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0].m_body, "seed");
    EXPECT_EQ(faults[0].m_other, "cube");
    EXPECT_NEAR(faults[0].m_depth, 0.47, 0.035) << "of its middle, or a point towards a corner";
}

TEST(SceneFaults, ABodyInAHoleHasNone)
{
    SceneRun run(R"({ "softBodies": [
        { "name": "shell", "mesh": { "box": [1, 1, 1], "cell": 0.1,
          "holes": [{ "low": [-0.3, -0.3, -0.3], "high": [0.3, 0.3, 0.3] }] } },
        { "name": "seed", "mesh": { "sphere": 0.1, "tets": 100 } }] })");
    EXPECT_THAT(faultsOf(run), IsEmpty());
}

TEST(SceneFaults, PinnedOrAnchoredOverlapIsNoFault)
{
    SceneRun pinned = cubeAnd(0, 0.4, kGround, R"(, "pins": [{ "low": [-1, -1, -1], "high": [1, -0.05, 1] }])");
    EXPECT_THAT(faultsOf(pinned), IsEmpty());
    const std::string hub = R"(], "rigidBodies": [{ "name": "hub", "shape": { "sphere": 0.3 }, "mass": 1 }])";
    SceneRun loose = cubeAnd(0, 0, hub);
    EXPECT_EQ(faultsOf(loose).size(), 1u);
    SceneRun anchored = cubeAnd(0, 0, hub + R"(, "constraints": [{ "kind": "anchor", "soft": "cube", "rigid": "hub",
        "nodes": { "low": [-0.3, -0.3, -0.3], "high": [0.3, 0.3, 0.3] } }])");
    EXPECT_THAT(faultsOf(anchored), IsEmpty());
}

TEST(SceneFaults, CountInvertedElements)
{
    SceneRun run = cubeAnd(0, 5, "]");
    SceneFrames frames(run.m_world);
    EXPECT_THAT(findFaults(run.m_world, frames), IsEmpty());
    btSoftBody& body = run.m_world.soft(0);
    const btVector3 way(0, 3, 0);
    body.m_nodes[0].m_x += way;  // far through all its elements to the other side
    int expected = 0;
    for (int e = 0; e < body.m_tetras.size(); ++e)
    {
        btVector3 edges[3];
        for (int a = 0; a < 3; ++a) edges[a] = body.m_tetras[e].m_n[a + 1]->m_x - body.m_tetras[e].m_n[0]->m_x;
        expected += edges[0].dot(edges[1].cross(edges[2])) < 0;
    }
    frames.update();
    const std::vector<SceneFault> faults = findFaults(run.m_world, frames);
    ASSERT_GT(expected, 0);
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_TRUE(faults[0].m_other.empty());
    EXPECT_EQ(faults[0].m_elements, expected);
    EXPECT_THAT(faults[0].sentence(), HasSubstr("'cube' has " + std::to_string(expected) + " element"));
}

TEST(SceneFaults, BoundEqualsThatOfTheManual)
{
    EXPECT_EQ(kDeepestShare, 0.05);
}

}  // namespace
}  // namespace bullet_fem
