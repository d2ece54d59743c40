// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/test_surfaces.h"

namespace bullet_fem
{
namespace
{

TEST(CageInput, RejectsCellSizesOutOfRange)
{
    const SurfaceMesh ball = sphereSurface(1, {}, 2);
    for (const double cell : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e-300})
        expectRejected([&] { makeCage(ball, withCell(cell)); },
                       {"cell size is", "m, outside [0.01", ", 2] m", "is sure to fit", "0.2 m is a good start"});
    expectRejected([&] { makeCage(ball, withCell(0)); }, {"cell size is 0 m"});
    expectRejected([&] { makeCage(ball, withCell(-1)); }, {"cell size is -1 m"});
    expectRejected([&] { makeCage(ball, withCell(2.5)); }, {"cell size is 2.5 m", ", 2] m", "longest side"});
    expectRejected([&] { makeCage(ball, withCell(std::numeric_limits<double>::infinity())); }, {"cell size is inf m"});
    // 100^3 cubes, half of them filled: within the lattice's limit, but too many elements.
    expectRejected([&] { makeCage(ball, withCell(0.02)); }, {"cell size of 0.02 m", "at least 20000", "[1, 200000]",
                                                             "use larger cells (0.0", "raise m_maxTets"});
}

TEST(CageInput, AcceptsTheCellSizeItSuggests)
{
    CageSettings settings = withCell(0);
    settings.m_maxTets = 1000;
    const SurfaceMesh box = boxSurface({0, 0, 0}, {1, 1, 1});
    expectRejected([&] { makeCage(box, settings); },
                   {"0.2002 m is sure to fit"});  // five cubes a side, and a thousandth of slack
    settings.m_cellSize = 0.2002;
    EXPECT_EQ(makeCage(box, settings).m_mesh.tetCount(), 625);
    settings.m_maxTets = 624;
    expectRejected([&] { makeCage(box, settings); }, {"at least 625 elements", "[1, 624]"});
    settings.m_cellSize = 0.25;  // aligned: outer elements are known to be kept only after sampling
    settings.m_maxTets = 319;
    expectRejected([&] { makeCage(box, settings); }, {"at least 320 elements", "[1, 319]"});
}

TEST(CageInput, RejectsSettingsOutOfRange)
{
    const SurfaceMesh box = boxSurface({0, 0, 0}, {1, 1, 1});
    const auto with = [&](auto member, auto value)
    {
        CageSettings settings = withCell(0.5);
        settings.*member = value;
        return [&box, settings] { makeCage(box, settings); };
    };
    expectRejected(with(&CageSettings::m_maxTets, 4), {"is 4", "[5, 5000000]", "m_maxTets"});
    expectRejected(with(&CageSettings::m_maxTets, 5000001), {"is 5000001", "[5, 5000000]"});
    expectRejected(with(&CageSettings::m_fillFloor, 0.0), {"is 0", "(0, 1]", "m_fillFloor"});
    expectRejected(with(&CageSettings::m_fillFloor, 1.5), {"is 1.5", "(0, 1]"});
    expectRejected(with(&CageSettings::m_fillFloor, std::nan("")), {"is nan", "(0, 1]"});
    expectRejected(with(&CageSettings::m_fillSamples, 7), {"are 7", "[8, 4096]", "m_fillSamples"});
    expectRejected(with(&CageSettings::m_fillSamples, 4097), {"are 4097", "[8, 4096]"});
}

TEST(CageInput, RejectsElementCountsOutOfRange)
{
    const SurfaceMesh box = boxSurface({0, 0, 0}, {1, 1, 1});
    CageSettings settings = withCell(0.5);
    settings.m_targetTets = 100;
    expectRejected([&] { makeCage(box, settings); },
                   {"both a cell size (0.5 m)", "elements (100)", "leave the other 0"});
    settings = withCell(0);
    for (const int target : {-1, 4, 200001})
    {
        settings.m_targetTets = target;
        expectRejected([&] { makeCage(box, settings); }, {"elements wanted", "outside [5, 200000]", "m_targetTets"});
    }
    expectRejected([&] { makeCage(box, CageSettings()); }, {"cell size is 0 m", "or give m_targetTets"});
}

TEST(CageInput, RejectsInvalidTriangleSoups)
{
    const SurfaceMesh box = boxSurface({0, 0, 0}, {1, 1, 1});
    expectRejected([&] { makeCage(without(box, 0, 12), withCell(0.5)); }, {"0 triangles", "at least 4"});
    expectRejected([] { makeCage(SurfaceMesh(), withCell(0.5)); }, {"0 triangles"});

    SurfaceMesh broken = box;
    broken.m_triangles[7][1] = 8;
    expectRejected([&] { makeCage(broken, withCell(0.5)); }, {"triangle 7", "vertex 8", "[0, 7]"});
    broken.m_triangles[7][1] = -1;
    expectRejected([&] { makeCage(broken, withCell(0.5)); }, {"triangle 7", "vertex -1", "[0, 7]"});

    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
    {
        broken = box;
        broken.m_vertices[3].z = bad;
        expectRejected([&] { makeCage(broken, withCell(0.5)); }, {"vertex 3", "not finite"});
    }
    expectRejected([] { makeCage(boxSurface({0, 0, 0}, {1, 1, 1e60}), withCell(0.5)); }, {"1e+60 m", "1e50", "scale"});
    expectRejected(
        [] {
            makeCage(boxSurface({1e9, 0, 0}, {1e9 + 1, 1, 1}), withCell(0.5));
        },
        {"1.7320508", "1000000001 m", "1e-07", "nearer to the origin"});
}

// At an edge of three triangles the wrongly oriented one is not determined.
TEST(CageInput, RejectsUnorientableTriangles)
{
    const SurfaceMesh ball = sphereSurface(1, {}, 3);
    SurfaceMesh fans = ball;
    const int tip = static_cast<int>(fans.m_vertices.size());
    fans.m_vertices.push_back({3, 0, 0});
    for (const Triangle& t : ball.m_triangles) fans.m_triangles.push_back({t[0], t[1], tip});
    expectRejected([&] { makeCage(fans, withCell(0.2)); },
                   {"not oriented", "of 2562 edges", "cannot be mended", "0.1", "counter-clockwise"});
}

TEST(CageInput, RejectsSurfacesWithoutInside)
{
    const SurfaceMesh box = boxSurface({0, 0, 0}, {1, 1, 1});
    SurfaceMesh point = box;
    for (Vec3& x : point.m_vertices) x = {1, 2, 3};
    expectRejected([&] { makeCage(point, withCell(0.1)); }, {"no inside", "flat", "0 m long"});

    expectRejected([&] { makeCage(without(box, 1, 12), withCell(0.1)); }, {"no inside", "flat", "0 m thick"});
    expectRejected([&] { makeCage(boxSurface({0, 0, 0}, {1, 1, 0}), withCell(0.1)); }, {"no inside", "flat"});

    SurfaceMesh bowl = sphereSurface(1, {}, 4);  // a shallow cap: 1 - z below 0.1
    std::vector<Triangle> cap;
    for (const Triangle& t : bowl.m_triangles)
        if (bowl.m_vertices[t[0]].z > 0.9) cap.push_back(t);
    bowl.m_triangles = cap;
    expectRejected([&] { makeCage(bowl, withCell(0.05)); }, {"no inside", "wide open", "0.9", "close its holes"});

    // Both sides of a bent sheet: closed, but without volume.
    SurfaceMesh strip;
    strip.m_vertices = {{0, 0, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1}, {2, 0, 0}, {2, 1, 0}};
    strip.m_triangles = {{0, 2, 1}, {1, 2, 3}, {2, 5, 3}, {2, 4, 5}};
    const SurfaceMesh sheet = joined(strip, flipped(strip));
    expectRejected([&] { makeCage(sheet, withCell(0.2)); },
                   {"no inside", "volume is", "0 open edges", "close the surface", "below 0.2 m"});
}

}  // namespace
}  // namespace bullet_fem
