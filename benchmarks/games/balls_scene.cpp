// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <array>
#include <map>

#include "benchmarks/games/game_scene.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/cage/surface_mesh.h"

namespace bullet_fem
{
namespace
{

constexpr double kBall = 0.5;   // radius [m]
constexpr double kCell = 0.14;  // cell size of the cages [m]
constexpr int kHalvings = 5;    // subdivisions: 20 * 4^5 triangles

SurfaceMesh icosahedron()
{
    const double g = 1.618033988749895;  // the golden ratio
    SurfaceMesh mesh;
    mesh.m_vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                       {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.m_triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    return mesh;
}

// Divides each triangle into four.
void halveEdges(SurfaceMesh& mesh)
{
    std::map<std::array<int, 2>, int> middles;
    const auto middle = [&](int i, int j)
    {
        const int next = static_cast<int>(mesh.m_vertices.size());
        const auto [at, isNew] = middles.insert({{std::min(i, j), std::max(i, j)}, next});
        if (isNew) mesh.m_vertices.push_back(0.5 * (mesh.m_vertices[i] + mesh.m_vertices[j]));
        return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.m_triangles)
    {
        const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.m_triangles = finer;
    for (Vec3& X : mesh.m_vertices) X *= 1 / norm(X);
}

SurfaceMesh ballSurface()
{
    SurfaceMesh ball = icosahedron();
    for (int k = 0; k < kHalvings; ++k) halveEdges(ball);
    for (Vec3& X : ball.m_vertices) X *= kBall;
    return ball;
}

void buildBalls(GameWorld& world, bool drawn)
{
    world.addRigid(new btStaticPlaneShape(btVector3(0, 1, 0), 0), 0, btVector3(0, 0, 0), 0.5);
    CageSettings settings;
    settings.m_cellSize = kCell;
    settings.m_surfaceCollides = drawn;
    // Cages extend beyond their surfaces by up to a cell.
    const double apart = drawn ? 2.01 * kBall : 2.01 * kBall + 2 * kCell, lowest = 0.5 * apart;
    for (const double height : {lowest, lowest + apart})
    {
        btSoftBody* ball = btFemHelpers::createFromSurface(world.info(), ballSurface(), settings);
        ball->translate(btVector3(0, btScalar(height), 0));
        world.addSoft(ball, 5e5, 1000, 0.5);
    }
}

}  // namespace

GameScene balls(bool drawn)
{
    const auto build = [drawn](GameWorld& world) { buildBalls(world, drawn); };
    return sceneOf(drawn ? "drawn balls" : "balls' cages", 120, 1, true, build);
}

}  // namespace bullet_fem
