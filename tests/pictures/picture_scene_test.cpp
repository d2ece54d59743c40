// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/picture_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "pictures/picture_shapes.h"
#include "tools/pictures/legend_text.h"
#include "tools/pictures/mesh_vertices.h"

namespace bullet_fem
{
namespace
{

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A scene with one object of each kind.
PictureScene fullScene()
{
    PictureScene scene = emptyScene();
    scene.m_meshes = {cube({0, 0, 0}, 1)};
    scene.m_meshes[0].m_scalars.assign(8, 0.5);
    scene.m_arrows = {PictureArrows{{PictureArrow{{0, 0, 0}, {0, 1, 0}}}}};
    return scene;
}

struct Fault
{
    const char* m_name;
    std::function<void(PictureScene&)> m_make;
    std::vector<const char*> m_words;
};

class PictureFault : public testing::TestWithParam<Fault>
{
};

TEST_P(PictureFault, IsNamedWithItsValueAndRange)
{
    PictureScene scene = fullScene();
    std::string why;
    ASSERT_TRUE(valid(scene, scene.m_camera, &why)) << why;
    GetParam().m_make(scene);
    EXPECT_FALSE(valid(scene, scene.m_camera, &why));
    for (const char* words : GetParam().m_words) EXPECT_THAT(why, HasSubstr(words));
}

INSTANTIATE_TEST_SUITE_P(
    All, PictureFault,
    testing::Values(
        Fault{"NaNPosition",
              [](PictureScene& s) { s.m_meshes[0].m_positions[3].y = kNaN; },
              {"mesh 0", "position 3", "nan"}},
        Fault{"HugePosition", [](PictureScene& s) { s.m_meshes[0].m_positions[3].y = 1e30; }, {"position 3", "1e+30"}},
        Fault{"IndexTooLarge",
              [](PictureScene& s) { s.m_meshes[0].m_triangles[5][1] = 8; },
              {"triangle 5", "index 8", "[0, 8)"}},
        Fault{
            "NegativeIndex", [](PictureScene& s) { s.m_meshes[0].m_triangles[5][1] = -1; }, {"triangle 5", "index -1"}},
        Fault{"ScalarsOfAnotherCount",
              [](PictureScene& s) { s.m_meshes[0].m_scalars.pop_back(); },
              {"7 scalars", "8 positions"}},
        Fault{"NaNScalar", [](PictureScene& s) { s.m_meshes[0].m_scalars[2] = kNaN; }, {"scalar 2", "finite"}},
        Fault{
            "CreaseAngle", [](PictureScene& s) { s.m_meshes[0].m_creaseAngle = 4; }, {"crease angle is 4", "[0, 3.14"}},
        Fault{"Colour", [](PictureScene& s) { s.m_meshes[0].m_colour.g = 1.5; }, {"colour", "1.5", "[0, 1]"}},
        Fault{
            "NaNArrow", [](PictureScene& s) { s.m_arrows[0].m_arrows[0].m_vector.x = kNaN; }, {"arrows 0", "vector 0"}},
        Fault{"ArrowScale", [](PictureScene& s) { s.m_arrows[0].m_scale = 0; }, {"arrows 0", "scale is 0", "> 0"}},
        Fault{"LongArrow",
              [](PictureScene& s) { s.m_arrows[0].m_scale = 1e14, s.m_arrows[0].m_arrows[0].m_vector.x = 1e10; },
              {"1e15"}},
        Fault{"ArrowThickness", [](PictureScene& s) { s.m_arrows[0].m_thickness = -1; }, {"thickness is -1", ">= 0"}},
        Fault{"GroundNormal",
              [](PictureScene& s) {
                  s.m_ground.m_normal = {0, 0, 0};
              },
              {"ground's normal", "length"}},
        Fault{"GridSpacing", [](PictureScene& s) { s.m_ground.m_gridSpacing = -0.1; }, {"grid spacing", "-0.1"}},
        Fault{"LightDirection",
              [](PictureScene& s) {
                  s.m_light.m_towards = {0, 0, 0};
              },
              {"towards the light", "length"}},
        Fault{"LightSize", [](PictureScene& s) { s.m_light.m_size = 2; }, {"light's size is 2", "[0, 0.5]"}},
        Fault{"EyeAtTarget",
              [](PictureScene& s) { s.m_camera.m_target = s.m_camera.m_eye; },
              {"eye and target", "differ"}},
        Fault{"UpAlongView",
              [](PictureScene& s) {
                  s.m_camera.m_up = {0, 0, -2};
              },
              {"up", "along its view"}},
        Fault{
            "FieldOfView", [](PictureScene& s) { s.m_camera.m_fieldOfView = 3.2; }, {"field of view is 3.2", "(0, 3)"}},
        Fault{"Bounds",
              [](PictureScene& s) {
                  s.m_bounds = PictureBounds{{1, 1, 1}, {1, 1, 1}};
              },
              {"bounds are (1, 1, 1)"}},
        Fault{
            "EmptyRange", [](PictureScene& s) { s.m_colourScale.m_high = s.m_colourScale.m_low; }, {"0 to 0", "below"}},
        Fault{"TextSize", [](PictureScene& s) { s.m_textSize = 0; }, {"text's size is 0", "[0.1, 10]"}}),
    [](const auto& fault) { return fault.param.m_name; });

TEST(PictureCamera, MapsRaysBackToTheirPixels)
{
    PictureCamera camera;
    camera.m_eye = {3, 2, -1};
    camera.m_target = {0.2, 0.1, 0.4};
    const PictureSize size{640, 360};
    for (const PicturePoint p : {PicturePoint{320, 180}, PicturePoint{0, 0}, PicturePoint{600.5, 33.25}})
    {
        const PictureRay ray = rayThrough(camera, size, p, 7);
        EXPECT_NEAR(norm(ray.m_to - ray.m_from), 7, 1e-12);
        const PicturePoint seen = projected(camera, size, ray.m_to);
        EXPECT_NEAR(seen.m_x, p.m_x, 1e-9);
        EXPECT_NEAR(seen.m_y, p.m_y, 1e-9);
    }
    const PicturePoint middle = projected(camera, size, camera.m_target);
    EXPECT_NEAR(middle.m_x, 320, 1e-9);
    EXPECT_NEAR(middle.m_y, 180, 1e-9);
    EXPECT_LT(projected(camera, size, camera.m_target + camera.m_up).m_y, 180) << "up is up";
}

TEST(PictureCamera, FramingHoldsTheWholeSceneAndFillsThePicture)
{
    PictureScene scene = emptyScene();
    scene.m_meshes = {cube({4, 5, 6}, 0.01)};
    const PictureSize size{400, 300};
    const PictureCamera camera = framing(scene, {1, 0.5, 0.3}, {0, 1, 0}, size);
    double largest = 0;
    for (const Vec3& x : scene.m_meshes[0].m_positions)
    {
        const PicturePoint p = projected(camera, size, x);
        largest = std::max({largest, std::abs(p.m_x / 200 - 1), std::abs(p.m_y / 150 - 1)});
    }
    EXPECT_LT(largest, 1);
    EXPECT_GT(largest, 0.85);
}

TEST(OrbitCamera, TurnsAtTheSameDistanceAndNeverTipsOver)
{
    OrbitCamera orbit;
    const PictureCamera start = orbit.camera();
    const double distance = norm(start.m_eye - start.m_target);
    orbit.orbit(0.3, 0.2);
    EXPECT_NEAR(norm(orbit.camera().m_eye - start.m_target), distance, 1e-12);
    EXPECT_GT(norm(orbit.camera().m_eye - start.m_eye), 0.2 * distance);
    orbit.orbit(-0.3, -0.2);
    EXPECT_NEAR(norm(orbit.camera().m_eye - start.m_eye), 0, 1e-12) << "the way back";
    orbit.orbit(0, 10);
    EXPECT_TRUE(valid(PictureScene{}, orbit.camera())) << "from above";
    EXPECT_GT(orbit.camera().m_eye.y, 0.99 * distance);
    orbit.orbit(0, -20);
    EXPECT_LT(orbit.camera().m_eye.y, -0.99 * distance);
}

TEST(OrbitCamera, PansWithThePictureAndZooms)
{
    OrbitCamera orbit;
    const PictureCamera start = orbit.camera();
    orbit.pan(0.25, 0);
    const Vec3 way = orbit.camera().m_target - start.m_target;
    EXPECT_NEAR(dot(way, axes(start).m_right), 0.25 * norm(start.m_eye - start.m_target), 1e-12);
    EXPECT_NEAR(norm(orbit.camera().m_eye - start.m_eye - way), 0, 1e-12);
    orbit.zoom(0.5);
    EXPECT_NEAR(norm(orbit.camera().m_eye - orbit.camera().m_target), 0.5 * norm(start.m_eye - start.m_target), 1e-12);
}

std::vector<std::string> texts(const PictureColourScale& scale)
{
    std::vector<std::string> all;
    for (const LegendLabel& label : legendLabels(scale)) all.push_back(label.m_text);
    return all;
}

TEST(Legend, TellsTheRangeInReadableUnits)
{
    const PictureColourScale stress{0, 2.5e6, "von Mises stress", "Pa"};
    EXPECT_EQ(legendTitle(stress), "von Mises stress [MPa]");
    EXPECT_THAT(texts(stress), ElementsAre("0", "0.625", "1.25", "1.875", "2.5"));
    const PictureColourScale moved{-0.004, 0.002, "displacement", "m"};
    EXPECT_EQ(legendTitle(moved), "displacement [mm]");
    EXPECT_THAT(texts(moved), ElementsAre("-4", "-2.5", "-1", "0.5", "2"));
    const PictureColourScale plain{0, 1e6, "rotation", ""};
    EXPECT_EQ(legendTitle(plain), "rotation");
    EXPECT_THAT(texts(plain), ElementsAre("0", "2.5e+05", "5e+05", "7.5e+05", "1e+06"));
    EXPECT_EQ(legendTitle({0, 1e6, "", "Pa"}), "[MPa]");
}

TEST(Legend, NamesTheQuantityOfArrows)
{
    PictureArrows arrows;
    arrows.m_title = "contact force";
    arrows.m_unit = "N";
    EXPECT_EQ(legendTitle(arrows), "contact force [N]");
    EXPECT_EQ(legendRange(arrows), "none yet");
    arrows.m_longest = 1254;
    EXPECT_EQ(legendTitle(arrows), "contact force [kN]");
    EXPECT_EQ(legendRange(arrows), "0 to 1.254");
    arrows.m_longest = 0.02;
    EXPECT_EQ(legendTitle(arrows), "contact force [mN]");
    EXPECT_EQ(legendRange(arrows), "0 to 20");
}

TEST(MeshVertices, KeepSharpEdgesSharpAndRoundOnesRound)
{
    PictureMesh box = cube({0, 0, 0}, 1);
    std::vector<PictureVertex> vertices;
    appendVertices(box, {}, {}, vertices);
    ASSERT_EQ(vertices.size(), 36u);
    for (const PictureVertex& v : vertices)
    {
        const float* n = v.m_normal;
        EXPECT_NEAR(std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}), 1, 1e-6) << "of a face";
        EXPECT_GT(n[0] * v.m_position[0] + n[1] * v.m_position[1] + n[2] * v.m_position[2], 0) << "outwards";
    }
    box.m_creaseAngle = 3;
    vertices.clear();
    appendVertices(box, {}, {}, vertices);
    for (const PictureVertex& v : vertices)
        EXPECT_LT(std::max({std::abs(v.m_normal[0]), std::abs(v.m_normal[1]), std::abs(v.m_normal[2])}), 0.9);
}

}  // namespace
}  // namespace bullet_fem
