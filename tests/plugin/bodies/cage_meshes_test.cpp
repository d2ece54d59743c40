// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Scanned and modelled surfaces: each mesh of a folder is made into a body by one call, and dropped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/io/surface_file.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

namespace fs = std::filesystem;

constexpr int kTargetTets = 1500;
constexpr std::size_t kMaxTriangles = 100000;
constexpr double kDensity = 1000;    // [kg/m3]
constexpr double kDropHeight = 0.1;  // [m]; bodies are 1 m long
constexpr int kSteps = 120;          // two seconds
constexpr int kEvery = 12;           // one in six is graded

struct NamedSurface
{
    std::string m_name;
    SurfaceMesh m_surface;
};

fs::path meshFolder()
{
    const char* chosen = std::getenv("BULLETFEM_TEST_MESHES");
    return chosen ? chosen : BULLETFEM_TEST_MESHES;
}

/// Reads a surface, scaled to a length of 1 m.
SurfaceMesh readScaled(const fs::path& file)
{
    SurfaceMesh surface = readSurfaceFile(file.string());
    Vec3 low = surface.m_vertices.front(), high = low;
    for (const Vec3& x : surface.m_vertices)
        for (int a = 0; a < 3; ++a)
        {
            low[a] = std::min(low[a], x[a]);
            high[a] = std::max(high[a], x[a]);
        }
    const Vec3 extent = high - low;
    for (Vec3& x : surface.m_vertices) x = (x - low) * (1 / std::max({extent.x, extent.y, extent.z}));
    return surface;
}

std::vector<NamedSurface> readMeshes()
{
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(meshFolder())) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<NamedSurface> result;
    for (const fs::path& file : files)
    {
        if (file.filename() == "b9.ply") continue;  // points without triangles
        NamedSurface surface{file.filename().string(), readScaled(file)};
        if (surface.m_surface.m_triangles.size() >= kMaxTriangles) continue;
        result.push_back(surface);
        if (surface.m_name != "elephant.off") continue;
        surface.m_name = "elephant.off, turned";
        for (Triangle& t : surface.m_surface.m_triangles) std::swap(t[1], t[2]);
        result.push_back(surface);
    }
    return result;
}

std::string findings(const CageReport& report)
{
    std::string text;
    const auto add = [&](int count, const char* what)
    {
        if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + what;
    };
    add(report.m_openEdges, " open edges");
    add(report.m_duplicates, " duplicates");
    add(report.m_degenerate, " without area");
    add(report.m_turned, " turned");
    if (report.m_insideOut) text += text.empty() ? "inside out" : ", inside out";
    if (report.m_selfIntersecting) text += text.empty() ? "intersects itself" : ", intersects itself";
    return text;
}

void expectInside(const btSoftBody& body, const SurfaceMesh& surface)
{
    ASSERT_EQ(body.m_renderNodes.size(), static_cast<int>(surface.m_vertices.size()));
    double minWeight = 1, farthest = 0;
    for (int v = 0; v < body.m_renderNodes.size(); ++v)
    {
        for (int a = 0; a < 4; ++a)
            minWeight = std::min(minWeight, double(body.m_renderNodesInterpolationWeights[v][a]));
        const btVector3& x = body.m_renderNodes[v].m_x;
        farthest = std::max(farthest, norm(Vec3{x.x(), x.y(), x.z()} - surface.m_vertices[v]));
    }
    EXPECT_GE(minWeight, -1e-6);
    EXPECT_LT(farthest, 1e-6);  // single precision, bodies of 1 m
}

double volumeOf(const btSoftBody::Tetra& tet)
{
    const btVector3 &o = tet.m_n[0]->m_x, a = tet.m_n[1]->m_x - o, b = tet.m_n[2]->m_x - o, c = tet.m_n[3]->m_x - o;
    return a.cross(b).dot(c) / 6;
}

/// Minimum of element volume over rest volume.
double minVolumeRatio(const btSoftBody& body, const std::vector<double>& atRest)
{
    double least = 1;
    for (int e = 0; e < body.m_tetras.size(); ++e) least = std::min(least, volumeOf(body.m_tetras[e]) / atRest[e]);
    return least;
}

class CageMeshes : public testing::Test
{
protected:
    /// Makes a body of one surface, drops it, and writes a line of the table.
    void tryOne(const NamedSurface& given)
    {
        SCOPED_TRACE(given.m_name);
        btFemSoftBodySolver fem;
        SoftWorld world(fem);
        world.addPlane();
        CageReport report;
        std::string why;
        CageSettings settings;
        settings.m_targetTets = kTargetTets;
        settings.m_snap = m_snap;
        settings.m_cellsAcross = m_cellsAcross;
        settings.m_fillSamples = 32;  // half the default, for speed
        std::unique_ptr<btSoftBody> body(
            btFemHelpers::createFromSurface(world.info(), given.m_surface, settings, report, &why));
        if (!body)
        {
            ++m_refused;
            EXPECT_NE(why.find("no inside"), std::string::npos) << why;
            return write(given, report, "refused: " + why.substr(0, why.find(':', 16)));
        }
        EXPECT_NEAR(report.m_tets, kTargetTets, (m_cellsAcross > 0 ? 0.45 : 0.2) * kTargetTets);
        EXPECT_GE(report.m_leastQuality, report.m_qualityBound);
        expectInside(*body, given.m_surface);
        fem.setMaterial(body.get(), material());
        if (report.m_openEdges > 0)
        {
            ++m_open;
            return write(given, report, "closed over its holes");
        }
        ++m_closed;
        const double mass = kDensity * trueVolume(given.m_surface, report);
        EXPECT_NEAR(massOf(*body), mass, 0.005 * mass);
        const double least = drop(world, *body.release());
        EXPECT_GT(least, 0);
        char text[64];
        std::snprintf(text, sizeof text, "dropped: least V/V0 %.2f", least);
        write(given, report, text);
    }

    /// The true volume by the divergence theorem if that holds; otherwise that of the repaired surface in the report,
    /// or for closed surfaces that overlap themselves by the samples of a finer cage. Surfaces with holes have no true
    /// volume.
    static double trueVolume(const SurfaceMesh& surface, const CageReport& report)
    {
        const bool overlaps = report.m_selfIntersecting && report.m_openEdges == 0;
        if (!overlaps) return report.m_turned > 0 ? report.m_surfaceVolume : std::abs(signedVolume(surface));
        CageSettings finer;
        finer.m_targetTets = 4 * kTargetTets;
        return makeCage(surface, finer).m_report.m_surfaceVolume;
    }

    /// Returns the minimum volume ratio after two seconds.
    static double drop(SoftWorld& world, btSoftBody& body)
    {
        std::vector<double> atRest;
        for (int e = 0; e < body.m_tetras.size(); ++e) atRest.push_back(volumeOf(body.m_tetras[e]));
        body.translate({0, 0, btScalar(kDropHeight - lowestHeight(body))});
        world.addSoft(&body);
        world.step(kSteps);
        EXPECT_TRUE(allFinite(body));
        EXPECT_GT(lowestHeight(body), -1e-3);
        return minVolumeRatio(body, atRest);
    }

    void write(const NamedSurface& given, const CageReport& report, const std::string& result) const
    {
        std::printf("%-32s %6zu %5d  %.3f  %5.2f %5.2f  %6d  %-34s %s\n", given.m_name.c_str(),
                    given.m_surface.m_triangles.size(), report.m_tets, report.m_leastQuality,
                    report.m_latticeVolumeRatio, report.m_volumeRatio, report.m_levels, findings(report).c_str(),
                    result.c_str());
    }

    static btFemMaterial material()
    {
        btFemMaterial result = btFemMaterial::rubber();
        result.m_youngModulus = btScalar(5e5);
        result.m_density = btScalar(kDensity);
        return result;
    }

    double m_snap = 0, m_cellsAcross = 0;
    int m_closed = 0, m_open = 0, m_refused = 0;
};

TEST_F(CageMeshes, BecomeBodies)
{
    if (!fs::is_directory(meshFolder()))
        GTEST_SKIP() << "no meshes in " << meshFolder() << "; tests/run.sh fetches them from libcgal-demo";
    std::printf("%-32s %6s %5s  %-5s  %-11s  %-6s  %-34s %s\n", "surface", "tris", "tets", "q", "cage/solid", "levels",
                "found", "result");
    int count = 0;
    for (const NamedSurface& surface : readMeshes())
    {
        m_snap = 1 - m_snap;                                  // alternately
        m_cellsAcross = count++ % kEvery / 2 == 3 ? 1.5 : 0;  // one of the two is snapped
        tryOne(surface);
    }
    std::printf("%d closed, %d open, %d refused\n", m_closed, m_open, m_refused);
    EXPECT_GE(m_closed, 80);
}

}  // namespace
}  // namespace bullet_fem
