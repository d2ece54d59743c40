// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <array>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

btSoftBody& addBall(FemWorld& world, const btVector3& center)
{
    btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), makeSphere(0.1, 4));
    ball->translate(center);
    btFemMaterial material;
    material.m_youngModulus = btScalar(2e5);
    material.m_density = 1000;
    world.fem().setMaterial(ball, material);
    return world.addSoft(ball);
}

// Bodies that graze a wall or each other receive impulses of rounding size along the whole fall.
TEST(Flush, BallsGrazingAWallAndEachOtherLandOnTheFloor)
{
    FemWorld world(WorldClass::softRigid);
    world.addFloorBox();
    world.addRigid(new btBoxShape(btVector3(0.5, 4, 2)), {0, at(btScalar(-0.83), 0, 2)});
    std::vector<btSoftBody*> balls;
    for (int k = 0; k < 24; ++k)
        balls.push_back(
            &addBall(world, {btScalar(-0.23) + btScalar(0.2) * btScalar(k % 2), btScalar(0.3) * btScalar(k / 2 - 6),
                             btScalar(0.3) + btScalar(0.05) * btScalar(k / 2)}));
    for (int k = 0; k < 60; ++k)
    {
        world.step(1);
        for (const btSoftBody* ball : balls) ASSERT_GT(lowestHeight(*ball), -0.03) << "step " << k;
    }
}

// A lattice of cubes without gaps.
struct Lattice
{
    std::array<int, 3> m_counts;  // of cubes along x, y, z
    double m_youngModulus;        // [Pa]
    bool m_walled;                // with walls on all sides
};

void PrintTo(const Lattice& lattice, std::ostream* stream)
{
    *stream << lattice.m_counts[0] << "_" << lattice.m_counts[1] << "_" << lattice.m_counts[2] << "_"
            << (lattice.m_walled ? "walled" : "free");
}

constexpr double kEdge = 0.2;  // of a cube [m]

std::vector<btSoftBody*> addCubes(FemWorld& world, const Lattice& lattice, double height, int cells = 4)
{
    std::vector<btSoftBody*> cubes;
    const auto [nx, ny, nz] = lattice.m_counts;
    for (int k = 0; k < nx * ny * nz; ++k)
    {
        const double x = kEdge * (k % nx - 0.5 * (nx - 1)), y = kEdge * (k / nx % ny - 0.5 * (ny - 1));
        SoftBox box;
        box.m_size = {kEdge, kEdge, kEdge};
        box.m_cells = {cells, cells, cells};
        box.m_center = {x, y, height + kEdge * (k / nx / ny + 0.5)};
        box.m_youngModulus = lattice.m_youngModulus;
        box.m_density = 100;
        cubes.push_back(&addSoftBox(world, world.fem(), box));
    }
    return cubes;
}

class LatticeOfCubes : public testing::TestWithParam<std::tuple<Coupling, Lattice>>
{
};

// The cubes fall together and approach each other by rounding only.
TEST_P(LatticeOfCubes, LandsOnTheFloor)
{
    const auto& [coupling, lattice] = GetParam();
    FemWorld world(WorldClass::softRigid, coupling);
    world.addFloorBox();
    if (lattice.m_walled) addWalls(world, 0.5 * kEdge * lattice.m_counts[0], 0.5 * kEdge * lattice.m_counts[1]);
    const std::vector<btSoftBody*> cubes = addCubes(world, lattice, 0.5);
    for (int k = 0; k < 50; ++k)
    {
        world.step(1);
        for (const btSoftBody* cube : cubes)
        {
            ASSERT_GT(lowestHeight(*cube), -0.03) << "step " << k;
            ASSERT_LT(fastestNode(*cube), 10) << "step " << k;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Flush, LatticeOfCubes,
    testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                     testing::Values(Lattice{{2, 1, 1}, 2e5, true}, Lattice{{1, 2, 2}, 2e4, true},
                                     Lattice{{1, 2, 4}, 2e4, false}, Lattice{{1, 3, 4}, 2e5, false},
                                     Lattice{{2, 2, 2}, 1e7, true})),
    [](const auto& scene)
    { return couplingName(std::get<0>(scene.param)) + ("_" + testing::PrintToString(std::get<1>(scene.param))); });

struct Jam
{
    int m_cells;    // along a cube's edge; fine cubes take longer
    double m_turn;  // beyond 45 degrees [rad]
    Coupling m_coupling = Coupling::coupled;
    bool m_hasBall = false;  // with a rigid ball on the cubes
    double m_damping = 1;    // of the steps [-]
};

void PrintTo(const Jam& jam, std::ostream* stream)
{
    *stream << jam.m_cells << " cells, " << jam.m_turn << " rad, " << couplingName(jam.m_coupling)
            << (jam.m_hasBall ? ", under a ball" : "") << (jam.m_damping < 1 ? ", second order" : "");
}

constexpr double kThrown = 40;  // rounding alone gives 3 to 20 m/s; a failure gave hundreds and more [m/s]

class JamOfCubes : public testing::TestWithParam<Jam>
{
};

// An unrealistic state: cubes 4 cm deep in walls and in each other, without room to separate. W is inaccurate at such
// strains, and outer iterations do not converge monotonically.
TEST_P(JamOfCubes, IsNotThrownApart)
{
    const Jam& jam = GetParam();
    btFemSolverInfo info;
    info.m_numericalDamping = info.m_contactDamping = btScalar(jam.m_damping);
    FemWorld world(WorldClass::softRigid, jam.m_coupling, {0, 0, btScalar(-kGravity)}, info);
    world.addFloorBox();
    addWalls(world, kEdge, kEdge);
    const std::vector<btSoftBody*> cubes = addCubes(world, {{2, 2, 2}, 1e7, true}, 0, jam.m_cells);
    for (btSoftBody* cube : cubes) cube->rotate(btQuaternion(btVector3(0, 0, 1), SIMD_PI / 4 + btScalar(jam.m_turn)));
    if (jam.m_hasBall) world.addRigid(new btSphereShape(btScalar(0.08)), {1, at(0, 0, btScalar(0.5))});
    for (int k = 0; k < 60; ++k)
    {
        world.step(1);
        for (const btSoftBody* cube : cubes) ASSERT_LT(fastestNode(*cube), kThrown) << "step " << k;
    }
}

INSTANTIATE_TEST_SUITE_P(Flush, JamOfCubes,
                         testing::Values(Jam{2, 0}, Jam{2, 2e-3}, Jam{2, 4e-3}, Jam{2, 6e-3}, Jam{4, 0}));

// Position correction uses implicit Euler: with less damping bodies reached 1e6 m/s.
INSTANTIATE_TEST_SUITE_P(SecondOrder, JamOfCubes,
                         testing::Values(Jam{2, 0, Coupling::coupled, false, 0}, Jam{4, 0, Coupling::coupled, false, 0},
                                         Jam{2, 6e-3, Coupling::swap, true, 0}));

INSTANTIATE_TEST_SUITE_P(UnderABall, JamOfCubes,
                         testing::Values(Jam{2, 3e-3, Coupling::swap, true}, Jam{2, 6e-3, Coupling::swap, true},
                                         Jam{2, 10e-3, Coupling::swap, true}, Jam{2, 14e-3, Coupling::swap, true},
                                         Jam{2, 4e-3, Coupling::coupled, true}, Jam{2, 7e-3, Coupling::coupled, true},
                                         Jam{2, 10e-3, Coupling::coupled, true},
                                         Jam{2, 14e-3, Coupling::coupled, true}));

}  // namespace
}  // namespace bullet_fem
