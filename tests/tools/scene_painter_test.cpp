// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Pictures of scenes: colours and shapes agree with formulas.
#include "tools/scene/scene_painter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <set>

#include "bullet_fem/io/colour_map.h"
#include "pictures/picture_shapes.h"
#include "tools/pictures/legend_text.h"
#include "tools/pictures/offscreen_renderer.h"
#include "tools/scene_run.h"

namespace bullet_fem
{
namespace
{

constexpr PictureSize kSize{640, 360};

/// A run with its picture.
struct PaintedRun
{
    PaintedRun(const std::string& json, double seconds) : m_run(json), m_frames(m_run.m_world)
    {
        m_painter.emplace(m_run.m_world, m_frames);
        m_run.until(seconds);
        m_frames.update();
        m_snapshot = snapshotOf(m_run.m_world, m_frames);
        m_painter->setHottest(hottestOf({m_snapshot}));
    }
    const PictureScene& picture() { return m_painter->paint(m_snapshot); }

    SceneRun m_run;
    SceneFrames m_frames;
    std::optional<ScenePainter> m_painter;
    SceneSnapshot m_snapshot;
};

class ScenePicture : public testing::Test
{
protected:
    void SetUp() override
    {
        try
        {
            m_renderer = std::make_unique<OffscreenRenderer>();
        }
        catch (const std::runtime_error& error)
        {
            GTEST_SKIP() << error.what();
        }
    }
    std::unique_ptr<OffscreenRenderer> m_renderer;
};

/// Position of a pixel's colour on the colour map, in [0, 1]: light and shadow change brightness, so that proportions
/// of red, green and blue are compared.
double heat(const std::array<int, 3>& pixel)
{
    double best = 0, least = 1e30;
    for (int k = 0; k <= 100; ++k)
    {
        const std::array<int, 3> colour = bytes(viridis(0.01 * k));
        double away = 0;
        for (int c = 0; c < 3; ++c)
            away += std::abs(double(pixel[c]) / (brightness(pixel) + 1) - double(colour[c]) / (brightness(colour) + 1));
        if (away < least) best = 0.01 * k;
        least = std::min(away, least);
    }
    return best;
}

TEST(SceneHeat, IsToldFromAColourInAnyLight)
{
    for (double s = 0; s <= 1; s += 0.05)
    {
        EXPECT_NEAR(heat(bytes(viridis(s))), s, 0.02);
        EXPECT_NEAR(heat(bytes(0.6 * viridis(s))), s, 0.05);
    }
}

const char* const kBeam =
    R"({ "step": 0.02, "softBodies": [{ "name": "beam", "mesh": { "box": [1, 0.2, 0.2], "cell": 0.04 },
    "material": { "young": 1e8, "poisson": 0.3, "stiffnessDamping": 0.1 },
    "pins": [{ "low": [-0.51, -1, -1], "high": [-0.49, 1, 1] }] }],
    "camera": { "direction": [0, 0.3, 1] }, "pictures": { "width": 640, "height": 360, "stress": true } })";

// The bending moment, and so the stress at the upper edge, falls from the clamp to the tip with the square of the
// distance.
TEST_F(ScenePicture, ABeamUnderItsWeightIsHottestAtTheClamp)
{
    PaintedRun beam(kBeam, 1.5);
    const Image image = m_renderer->render(beam.picture(), kSize);
    const PictureCamera camera = beam.picture().m_camera;
    std::vector<double> alongTheEdge;
    for (const double x : {-0.47, -0.35, -0.2, 0., 0.3})
        alongTheEdge.push_back(heat(pixelAt(image, camera, {x, 0.09, 0.1})));
    for (std::size_t i = 1; i < alongTheEdge.size(); ++i) EXPECT_LT(alongTheEdge[i], alongTheEdge[i - 1]) << i;
    EXPECT_GT(alongTheEdge.front(), 0.8) << "nearly the last colour";
    EXPECT_LT(alongTheEdge.back(), 0.2) << "nearly the first one";
    for (double x = -0.3; x < 0.49; x += 0.05)
        for (double y = -0.08; y < 0.09; y += 0.04)
            EXPECT_LT(heat(pixelAt(image, camera, {x, y, 0.1})), alongTheEdge.front()) << x << ' ' << y;
}

TEST_F(ScenePicture, IsNotEmptyAndTheSameAgain)
{
    PaintedRun first(kBeam, 0.2), second(kBeam, 0.2);
    const Image image = m_renderer->render(first.picture(), kSize);
    std::set<std::array<int, 3>> colours;
    for (int y = 0; y < kSize.m_height; ++y)
        for (int x = 0; x < kSize.m_width; ++x) colours.insert(image.at(x, y));
    EXPECT_GT(colours.size(), 500u) << "shades of the colour map and of the sky";
    EXPECT_EQ(m_renderer->render(first.picture(), kSize).m_pixels, image.m_pixels);
    EXPECT_EQ(OffscreenRenderer().render(second.picture(), kSize).m_pixels, image.m_pixels)
        << "another world and context";
}

// The number at the legend's upper end, in Pa.
double legendEnd(const PictureColourScale& scale)
{
    const std::string title = legendTitle(scale), label = legendLabels(scale).back().m_text;
    EXPECT_EQ(legendLabels(scale).back().m_share, 1);
    EXPECT_NE(title.find("[kPa]"), std::string::npos) << title;
    return 1000 * std::stod(label);
}

// A bar of 5 m x 0.1 m x 0.1 m with a force at its end: the stress is F / A except near the end, where equal nodal
// forces overload the rim. By Saint-Venant's principle that decays within one width, 2 % of the length: the colour
// scale ignores so few nodes. Poisson's ratio is 0, because the clamp would be such an end otherwise.
TEST(SceneLegend, ShowsForceOverAreaOfABarInTension)
{
    PaintedRun bar(
        R"({ "gravity": [0, 0, 0], "step": 0.05, "softBodies": [{ "name": "bar", "mesh": { "box": [5, 0.1, 0.1], "cell": 0.025 },
        "material": { "young": 1e6, "poisson": 0, "stiffnessDamping": 0.05 },
        "pins": [{ "low": [-2.51, -1, -1], "high": [-2.49, 1, 1] }] }],
        "forces": [{ "body": "bar", "force": [100, 0, 0], "nodes": { "low": [2.49, -1, -1], "high": [2.51, 1, 1] } }],
        "pictures": { "stress": true } })",
        5);
    const double expected = 100 / (0.1 * 0.1);
    EXPECT_NEAR(hottestOf({bar.m_snapshot}), expected, 0.02 * expected);
    EXPECT_NEAR(legendEnd(bar.picture().m_colourScale), expected, 0.02 * expected);
    std::vector<double> stress = bar.m_snapshot.m_vonMises[0];
    std::sort(stress.begin(), stress.end());
    EXPECT_NEAR(stress[stress.size() / 2], expected, 0.002 * expected) << "the bar's middle";
    EXPECT_GT(stress.back(), 1.1 * expected) << "the rim of the end, which the scale leaves out";
}

// A bar that splits under a force beyond its strength: films show the crack faces, and earlier pictures do not.
TEST(SceneCracks, AreDrawnFromTheirTimeOn)
{
    PaintedRun bar(
        R"({ "gravity": [0, 0, 0], "softBodies": [{ "name": "bar", "mesh": { "box": [1, 0.2, 0.2], "cell": 0.1 },
        "material": { "young": 1e5 }, "fracture": { "tension": 1000 },
        "pins": [{ "low": [-1, -1, -1], "high": [-0.49, 1, 1] }] },
        { "name": "other", "mesh": { "box": [1, 1, 1], "tets": 40 }, "position": [0, 0, -3] }],
        "forces": [{ "body": "bar", "force": [100, 0, 0] }], "pictures": { "stress": true } })",
        0);
    const SceneSnapshot before = bar.m_snapshot;
    const std::size_t whole = bar.picture().m_meshes[0].m_triangles.size();
    bar.m_run.until(1);
    bar.m_frames.update();
    bar.m_snapshot = snapshotOf(bar.m_run.m_world, bar.m_frames);
    ASSERT_GE(bar.m_run.m_world.fractures().bodies()[0].m_parts, 2);
    const PictureMesh cracked = bar.picture().m_meshes[0];
    EXPECT_GE(cracked.m_triangles.size(), whole + 16) << "both sides of a section of four cells, two triangles each";
    EXPECT_EQ(cracked.m_scalars.size(), cracked.m_positions.size());
    for (const Triangle& t : cracked.m_triangles)
        for (const int v : t) ASSERT_LT(v, int(cracked.m_positions.size()));
    EXPECT_TRUE(bar.m_snapshot.m_triangles[1].empty()) << "of a body that does not split";
    bar.m_snapshot = before;
    EXPECT_EQ(bar.picture().m_meshes[0].m_triangles.size(), whole);
}

TEST(SceneArrows, AreTheContactForces)
{
    PaintedRun block(
        R"({ "softBodies": [{ "name": "block", "mesh": { "box": [0.4, 0.4, 0.4], "tets": 500 }, "position": [0, 0.2, 0],
        "material": { "young": 1e6, "poisson": 0.2, "stiffnessDamping": 0.05 } }],
        "rigidBodies": [{ "name": "ground", "shape": { "plane": [0, 1, 0] } }], "pictures": { "forces": true } })",
        1.5);
    const PictureScene& picture = block.picture();
    ASSERT_EQ(picture.m_arrows.size(), 1u);
    Vec3 sum;
    for (const PictureArrow& arrow : picture.m_arrows[0].m_arrows)
    {
        sum += arrow.m_vector;
        EXPECT_NEAR(arrow.m_origin.y, 0, 1e-3) << "at the ground";
    }
    const double weight = 64 * 9.81;
    EXPECT_NEAR(norm(sum - Vec3{0, weight, 0}), 0, 2e-3 * weight);
    EXPECT_TRUE(picture.m_ground.m_shown);
    EXPECT_EQ(picture.m_ground.m_normal.y, 1);
    EXPECT_TRUE(picture.m_meshes[0].m_scalars.empty()) << "no stress was asked for";
}

}  // namespace
}  // namespace bullet_fem
