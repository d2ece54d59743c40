// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

#include "benchmarks/games/game_scene.h"
#include "benchmarks/games/tetgen_source.h"

namespace bullet_fem
{
namespace
{

constexpr double kGravityOfSoftDemo = 10;  // [m/s2]
constexpr int kWaves = 30;                 // vertices along an edge of the ground
constexpr btScalar kSquare = 8;            // edge of the ground's squares [m]

void addWaves(GameWorld& world)
{
    auto triangles = std::make_shared<btTriangleMesh>();
    const auto vertex = [](int i, int j)
    {
        const double height = 5 * std::sin(double(i)) * std::cos(double(j - 50));
        return btVector3(kSquare * btScalar(i - kWaves / 2), btScalar(height), kSquare * btScalar(j - kWaves / 2));
    };
    for (int i = 0; i + 1 < kWaves; ++i)
        for (int j = 0; j + 1 < kWaves; ++j)
        {
            triangles->addTriangle(vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j));
            triangles->addTriangle(vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1));
        }
    auto* shape = new btBvhTriangleMeshShape(triangles.get(), true);
    shape->setMargin(btScalar(0.5));
    world.keep(triangles);
    world.addRigid(shape, 0, btVector3(0, -12, 0), 0.5);
}

void prepareInfo(btSoftBodyWorldInfo& info)
{
    info.m_gravity.setValue(0, btScalar(-kGravityOfSoftDemo), 0);
    info.air_density = btScalar(1.2);
    info.water_density = 0;
    info.water_offset = 0;
    info.m_sparsesdf.Initialize();
}

void buildBunny(GameWorld& world, const TetGenSource& source)
{
    prepareInfo(world.info());
    addWaves(world);
    btSoftBody* bunny = btSoftBodyHelpers::CreateFromTetGenData(world.info(), source.m_elements.c_str(), nullptr,
                                                                source.m_nodes.c_str(), false, true, true);
    bunny->rotate(btQuaternion(SIMD_PI / 2, 0, 0));
    bunny->setVolumeMass(150);
    bunny->m_cfg.piterations = 2;
    bunny->m_cfg.collisions = btSoftBody::fCollision::CL_SS + btSoftBody::fCollision::CL_RS;
    bunny->generateClusters(0);
    bunny->m_cfg.kDF = 10;
    bunny->setActivationState(DISABLE_DEACTIVATION);
    world.addSoft(bunny);
}

double volumeOf(const btSoftBody& body)
{
    double volume = 0;
    for (int e = 0; e < body.m_tetras.size(); ++e)
    {
        const btVector3& x = body.m_tetras[e].m_n[0]->m_x;
        volume += double((body.m_tetras[e].m_n[1]->m_x - x)
                             .cross(body.m_tetras[e].m_n[2]->m_x - x)
                             .dot(body.m_tetras[e].m_n[3]->m_x - x)) /
                  6;
    }
    return std::abs(volume);
}

}  // namespace

GameScene tetraBunny(const std::string& bulletSource)
{
    GameScene scene;
    scene.m_name = "TetraBunny";
    scene.m_frames = 300;
    scene.m_carriesItsWeight = true;
    scene.m_isOfBullet = true;
    if (bulletSource.empty()) scene.m_missing = "its mesh is in Bullet's source tree; give that by --bullet-source";
    scene.m_start = [bulletSource](const GameSettings& settings)
    {
        auto world = std::make_unique<GameWorld>(settings, kGravityOfSoftDemo);
        buildBunny(*world, readTetGenSource(bulletSource + "/examples/SoftDemo/bunny.inl"));
        const double volume = volumeOf(*world->world().soft()[0]);
        world->setOutcome(
            [volume](const GameWorld& all)
            {
                const btSoftBody& bunny = *all.world().soft()[0];
                double fastest = 0;
                for (int i = 0; i < bunny.m_nodes.size(); ++i)
                    fastest = std::max(fastest, double(bunny.m_nodes[i].m_v.length()));
                std::ostringstream text;
                text.precision(3);
                text << "volume " << volumeOf(bunny) / volume << " of that at rest, fastest node " << fastest << " m/s";
                return text.str();
            });
        return world;
    };
    return scene;
}

}  // namespace bullet_fem
