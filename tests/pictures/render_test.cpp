// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bullet_fem/io/colour_map.h"
#include "io/temporary_folder.h"
#include "pictures/picture_shapes.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;

constexpr PictureSize kSize{320, 240};

/// One renderer for all tests, because creating a context is slow.
Image render(const PictureScene& scene, const PictureSize& size = kSize)
{
    static OffscreenRenderer renderer;
    return renderer.render(scene, size);
}

int differentPixels(const Image& a, const Image& b)
{
    int count = 0;
    for (std::size_t i = 0; i < a.m_pixels.size(); i += 3)
        count += !std::equal(&a.m_pixels[i], &a.m_pixels[i] + 3, &b.m_pixels[i]);
    return count;
}

TEST(Render, ShowsSomething)
{
    PictureScene scene;
    scene.m_meshes = {ball({0, 0.5, 0}, 0.5)};
    const Image image = render(scene);
    std::set<std::array<int, 3>> colours;
    for (int y = 0; y < kSize.m_height; ++y)
        for (int x = 0; x < kSize.m_width; ++x) colours.insert(image.at(x, y));
    EXPECT_GT(colours.size(), 500u) << "shades of ball, ground, shadow and sky";
}

/// A ball, off the picture's middle: each pixel whose ray misses the sphere is background, each other one is the
/// ball's.
TEST(Render, BallSilhouetteFollowsTheProjection)
{
    const Vec3 centre{0.9, 0.5, -0.4};
    const double radius = 0.6, chord = radius * (1 - std::cos(std::acos(-1.) / 96));  // polyhedron inside the sphere
    PictureScene scene = emptyScene();
    scene.m_meshes = {ball(centre, radius)};
    scene.m_meshes[0].m_colour = {1, 0, 0};
    scene.m_meshes[0].m_lit = false;
    const Image image = render(scene);
    const CameraAxes a = axes(scene.m_camera);
    const double pixel =
        2 * std::tan(0.5 * scene.m_camera.m_fieldOfView) / kSize.m_height * norm(centre - scene.m_camera.m_eye);
    int inside = 0;
    for (int y = 0; y < kSize.m_height; ++y)
        for (int x = 0; x < kSize.m_width; ++x)
        {
            const PictureRay ray = rayThrough(scene.m_camera, kSize, {x + 0.5, y + 0.5}, 1);
            const double miss = norm(cross(centre - ray.m_from, ray.m_to - ray.m_from));
            const bool isBall = image.at(x, y) == std::array<int, 3>{255, 0, 0};
            const bool touched = image.at(x, y)[1] < 150;
            ASSERT_TRUE(isBall || miss > radius - chord - pixel) << x << ' ' << y;
            ASSERT_TRUE(!touched || miss < radius + pixel) << x << ' ' << y;
            inside += isBall;
        }
    EXPECT_GT(inside, 1000);
    EXPECT_GT(dot(a.m_right, centre), 0);
}

/// Light from the upper left: the ball's shadow is at the intersection of the ground and the ray through its centre.
TEST(Render, ShadowFollowsTheGeometry)
{
    PictureScene scene;
    const Vec3 centre{0, 1, 0}, towards{-1, 1, 0};
    scene.m_meshes = {ball(centre, 0.3)};
    scene.m_light.m_towards = towards;
    scene.m_ground.m_gridSpacing = 0;
    scene.m_camera.m_eye = {0, 3, 6};
    const Vec3 shadow = centre - (centre.y / towards.y) * towards, mirrored{-shadow.x, 0, shadow.z};
    const auto brightnessAt = [&](const Image& image, const Vec3& x)
    { return brightness(pixelAt(image, scene.m_camera, x)); };
    const Image image = render(scene);
    EXPECT_LT(brightnessAt(image, shadow), 0.8 * brightnessAt(image, mirrored));
    for (const Vec3 beside : {Vec3{0.55, 0, 0}, Vec3{-0.55, 0, 0}, Vec3{0, 0, 0.45}, Vec3{0, 0, -0.45}})
        EXPECT_GT(brightnessAt(image, shadow + beside), 0.9 * brightnessAt(image, mirrored))
            << beside.x << ' ' << beside.z;
    for (const Vec3 within : {Vec3{0.3, 0, 0}, Vec3{-0.3, 0, 0}, Vec3{0, 0, 0.2}, Vec3{0, 0, -0.2}})  // 0.42 by 0.3
        EXPECT_LT(brightnessAt(image, shadow + within), 0.87 * brightnessAt(image, mirrored))
            << within.x << ' ' << within.z;
    scene.m_light.m_shadows = false;
    EXPECT_GT(brightnessAt(render(scene), shadow), 0.97 * brightnessAt(image, mirrored));
}

TEST(Render, LitSidesAreBrighter)
{
    PictureScene scene = emptyScene();
    scene.m_meshes = {ball({0, 0, 0}, 1)};
    scene.m_light.m_towards = {1, 0.2, 0.5};
    const Image image = render(scene);
    EXPECT_GT(brightness(pixelAt(image, scene.m_camera, {0.7, 0, 0.7})),
              1.5 * brightness(pixelAt(image, scene.m_camera, {-0.8, 0, 0.6})));
}

TEST(Render, ScalarsShowTheColourMapFromEndToEnd)
{
    PictureScene scene = emptyScene();
    scene.m_meshes = {rectangle({0, 0, 0}, {1, 0, 0}, {0, 0.5, 0})};
    scene.m_meshes[0].m_scalars = {100, 300, 300, 100};
    scene.m_meshes[0].m_lit = false;
    scene.m_colourScale = {100, 300, "", "", false};
    const Image image = render(scene);
    for (const double share : {0.01, 0.25, 0.5, 0.75, 0.99})
        EXPECT_LE(difference(pixelAt(image, scene.m_camera, {2 * share - 1, 0.1, 0}), bytes(viridis(share))), 2)
            << share;
    scene.m_meshes[0].m_scalars = {-1e300, 1e300, 1e300, -1e300};  // beyond the scale: clamped
    const Image beyond = render(scene);
    EXPECT_LE(difference(pixelAt(beyond, scene.m_camera, {-0.5, 0, 0}), bytes(viridis(0))), 1);
    EXPECT_LE(difference(pixelAt(beyond, scene.m_camera, {0.5, 0, 0}), bytes(viridis(1))), 1);
}

TEST(Render, LegendHasTheColourMapItsTitleAndItsNumbers)
{
    PictureScene scene = emptyScene();
    scene.m_meshes = {rectangle({-1, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0})};
    scene.m_meshes[0].m_scalars = {0, 1, 1, 0};
    scene.m_colourScale = {0, 1e6, "von Mises stress", "Pa"};
    const Image image = render(scene);
    const auto nearest = [&](const Vec3& colour)  // of all pixels in the right half
    {
        int least = 255;
        for (int y = 0; y < kSize.m_height; ++y)
            for (int x = kSize.m_width / 2; x < kSize.m_width; ++x)
                least = std::min(least, difference(image.at(x, y), bytes(colour)));
        return least;
    };
    for (const double share : {0., 0.25, 0.5, 0.75, 1.}) EXPECT_LE(nearest(viridis(share)), 4) << share;

    PictureScene other = scene;
    other.m_colourScale.m_title = "Mises von stress";  // of equal width
    EXPECT_GT(differentPixels(image, render(other)), 5) << "the title";
    other = scene;
    other.m_colourScale.m_high = 2e6;
    EXPECT_GT(differentPixels(image, render(other)), 5) << "the numbers";
    other = scene;
    other.m_colourScale.m_legend = false;
    EXPECT_GT(differentPixels(image, render(other)), 1000) << "no legend";
    other.m_meshes[0].m_scalars.clear();
    const Image bare = render(other);
    other.m_colourScale.m_legend = true;
    EXPECT_EQ(differentPixels(bare, render(other)), 0) << "no scalars, no legend";
    other.m_caption = "t = 1 s, 5 µm, \xff\xe2\x82";  // with invalid UTF-8, too
    const Image captioned = render(other);
    EXPECT_GT(differentPixels(bare, captioned), 20) << "the caption";
    other.m_textSize = 2;
    EXPECT_GT(differentPixels(bare, render(other)), 2 * differentPixels(bare, captioned)) << "larger letters";
    std::swap(other.m_title, other.m_caption);
    const Image titled = render(other);
    EXPECT_GT(differentPixels(bare, titled), 40) << "the title";
    const std::size_t lowerHalf = bare.m_pixels.size() / 2;
    EXPECT_TRUE(
        std::equal(&bare.m_pixels[lowerHalf], bare.m_pixels.data() + bare.m_pixels.size(), &titled.m_pixels[lowerHalf]))
        << "the title is above";
}

TEST(Render, WireframeDrawsEdgesOverTheSurface)
{
    PictureScene scene = emptyScene();
    scene.m_meshes = {rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})};
    const Image plain = render(scene);
    scene.m_meshes[0].m_wireframe = true;
    const Image wired = render(scene);
    const auto darker = [&](const Vec3& x)
    { return brightness(pixelAt(wired, scene.m_camera, x)) - brightness(pixelAt(plain, scene.m_camera, x)); };
    EXPECT_LT(darker({0.001, 0.001, 0}), -60) << "the diagonal";
    EXPECT_EQ(darker({0.5, -0.5, 0}), 0) << "inside a triangle";
    EXPECT_EQ(darker({-0.5, 0.5, 0}), 0);
}

TEST(Render, ArrowsReachAsFarAsTheirScaleSays)
{
    PictureScene scene = emptyScene();
    scene.m_meshes = {rectangle({0, 0, -0.2}, {0.5, 0, 0}, {0, 0.5, 0})};
    const Image bare = render(scene);
    PictureArrows forces;
    forces.m_arrows = {{{-0.4, 0, 0}, {0, 800, 0}}, {{0.4, 0, 0}, {0, 0.5, 0}}};
    forces.m_scale = 1e-3;
    forces.m_thickness = 0.05;
    forces.m_colour = {0.1, 0.8, 0.1};
    scene.m_arrows = {forces};
    const Image image = render(scene);
    const auto green = [&](const Vec3& x)
    {
        const std::array<int, 3> p = pixelAt(image, scene.m_camera, x);
        return p[1] > 1.5 * p[0] && p[1] > 1.5 * p[2];
    };
    EXPECT_TRUE(green({-0.4, 0.02, 0}));
    EXPECT_TRUE(green({-0.4, 0.4, 0}));
    EXPECT_TRUE(green({-0.4, 0.78, 0}));
    EXPECT_TRUE(green({-0.35, 0.62, 0})) << "the head is wider";
    EXPECT_FALSE(green({-0.35, 0.4, 0})) << "than the shaft";
    EXPECT_FALSE(green({-0.4, 0.83, 0}));
    EXPECT_FALSE(green({-0.4, -0.03, 0}));
    EXPECT_EQ(pixelAt(image, scene.m_camera, {0.4, 0, 0}), pixelAt(bare, scene.m_camera, {0.4, 0, 0})) << "too short";
}

TEST(Render, ArrowsBehindSurfacesShineThrough)
{
    PictureScene scene = emptyScene();
    scene.m_meshes = {rectangle({0, 0, 0.2}, {1, 0, 0}, {0, 1, 0})};
    scene.m_meshes[0].m_colour = {0.8, 0.8, 0.8};
    scene.m_light.m_towards = {0, 0.3, 1};
    const Image bare = render(scene);
    scene.m_arrows = {PictureArrows{{PictureArrow{{0, -0.4, -0.3}, {0, 0.8, 0}}}, 1, 0.08, {1, 0, 0}}};
    const Image image = render(scene);
    const std::array<int, 3> before = pixelAt(bare, scene.m_camera, {0, 0, 0.2}),
                             after = pixelAt(image, scene.m_camera, {0, 0, 0.2});
    EXPECT_LT(after[1], 0.8 * before[1]);
    EXPECT_GT(after[1], 0.3 * before[1]) << "but faintly";
    EXPECT_GT(after[0], 1.3 * after[1]) << "in its colour";
}

TEST(Render, GroundIsSeenFromAboveOnlyAndHasAGrid)
{
    PictureScene scene;
    scene.m_meshes = {cube({0, 0.5, 0}, 0.1)};
    scene.m_camera.m_eye = {0.5, 0.6, 2};
    const Image grid = render(scene);
    scene.m_ground.m_gridSpacing = 0;
    const Image plain = render(scene);
    EXPECT_GT(differentPixels(grid, plain), 500);
    scene.m_camera.m_eye = {0.5, -0.6, 2};
    const Image below = render(scene);
    scene.m_ground.m_shown = false;
    EXPECT_LT(differentPixels(below, render(scene)), 3000) << "no ground, but still its share of the light on the cube";
}

TEST(Render, TwoRendersAreIdentical)
{
    PictureScene scene;
    scene.m_meshes = {ball({0, 0.5, 0}, 0.5), cube({1, 0.2, 0.3}, 0.2)};
    scene.m_meshes[0].m_wireframe = true;
    for (const Vec3& x : scene.m_meshes[0].m_positions) scene.m_meshes[0].m_scalars.push_back(x.y);
    scene.m_arrows = {PictureArrows{{PictureArrow{{0, 0, 0}, {0.3, 1, 0}}}}};
    const Image first = render(scene);
    render(emptyScene());
    EXPECT_EQ(render(scene).m_pixels, first.m_pixels);
    OffscreenRenderer another;
    EXPECT_EQ(another.render(scene, kSize).m_pixels, first.m_pixels);
}

/// A scene that is moved far away, or scaled by a thousand, gives an equal picture.
TEST(Render, PlaceAndSizeOfTheWorldDoNotMatter)
{
    const auto scene = [](const Vec3& origin, double unit)
    {
        PictureScene s;
        s.m_meshes = {ball(origin + unit * Vec3{0, 0.5, 0}, 0.5 * unit),
                      cube(origin + unit * Vec3{0.8, 0.25, 0.1}, 0.25 * unit)};
        s.m_ground.m_point = origin;
        s.m_ground.m_gridSpacing = 0.5 * unit;
        s.m_camera.m_eye = origin + unit * s.m_camera.m_eye;
        s.m_camera.m_target = origin;
        return render(s);
    };
    const Image here = scene({0, 0, 0}, 1);
    const int few = kSize.m_width * kSize.m_height / 200;  // rounding changes single texels of the shadow map
    EXPECT_LT(differentPixels(here, scene({1e6, 2e6, -3e6}, 1)), few);
    EXPECT_LT(differentPixels(here, scene({0, 0, 0}, 1e-3)), few);
    EXPECT_LT(differentPixels(here, scene({0, 0, 0}, 1e3)), few);
}

/// An object that leaves the picture changes the ground in it, unless the film has bounds.
TEST(Render, BoundsKeepTheGroundOfAFilmTheSame)
{
    PictureScene scene;
    scene.m_light.m_towards = {0, 1, 0};
    const auto frame = [&](double height)
    {
        scene.m_meshes = {cube({0, 0.1, 0}, 0.1), cube({30, height, 0}, 0.1)};
        return render(scene);
    };
    EXPECT_GT(differentPixels(frame(1), frame(80)), 1500);
    scene.m_bounds = PictureBounds{{-1, 0, -1}, {1, 1, 1}};
    EXPECT_LT(differentPixels(frame(1), frame(80)), 50) << "texels of the shadow";
    const Image crowded = frame(80);
    scene.m_meshes.pop_back();
    EXPECT_LT(differentPixels(crowded, render(scene)), 50) << "the far object does not coarsen shadows";
}

TEST(Render, EmptyScenesAndFlatMeshesAreDrawn)
{
    PictureScene scene;
    EXPECT_NO_THROW(render(scene));
    scene.m_meshes = {PictureMesh{}, PictureMesh{}};
    scene.m_meshes[0].m_positions.assign(3, {1, 1, 1});
    scene.m_meshes[0].m_triangles = {{0, 1, 2}, {0, 0, 0}};
    scene.m_meshes[0].m_wireframe = true;
    scene.m_arrows = {PictureArrows{}};
    scene.m_light.m_towards = {1, 0, 0};  // parallel to the ground
    EXPECT_NO_THROW(render(scene));
}

TEST(Render, RejectsBadScenesAndSizes)
{
    PictureScene scene;
    scene.m_meshes = {cube({0, 0, 0}, 1)};
    for (const PictureSize size : {PictureSize{0, 240}, PictureSize{320, -1}, PictureSize{320, 1 << 20}})
        EXPECT_THAT(messageOf<std::invalid_argument>([&] { render(scene, size); }), HasSubstr("must be in [1, "));
    scene.m_meshes[0].m_positions[0].x = std::nan("");
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { render(scene); }), HasSubstr("mesh 0: position 0"));
    scene.m_meshes[0].m_positions[0].x = 0;
    EXPECT_NO_THROW(render(scene)) << "the renderer still works";
}

TEST(RenderDeathTest, AdvisesInstallingADriverWithoutEgl)
{
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    const auto withoutDriver = []
    {
        setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent", 1);
        const std::string why = messageOf<std::runtime_error>([] { OffscreenRenderer renderer; });
        fprintf(stderr, "%s\n", why.c_str());
        std::exit(0);
    };
    EXPECT_EXIT(withoutDriver(), testing::ExitedWithCode(0), "install an OpenGL driver for EGL");
}

}  // namespace
}  // namespace bullet_fem
