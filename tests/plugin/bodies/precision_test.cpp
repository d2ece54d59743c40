// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The difference between Bullet's precisions: resolution far from the origin.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <type_traits>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

#if defined(BULLETFEM_PRECISION_float64)
static_assert(std::is_same_v<btScalar, double>);
#else
static_assert(std::is_same_v<btScalar, float>);
#endif

constexpr double kEpsilon = static_cast<double>(std::numeric_limits<btScalar>::epsilon());

/// Node positions relative to `origin` [m], a second after a soft cube was dropped there on a static box. The scene has
/// no other objects, so that its result should not depend on the origin.
std::vector<Vec3> placesAfterAFall(const Vec3& origin, Coupling coupling)
{
    btFemSolverInfo info;
    info.m_tolerance = btScalar(1e-8);  // element kernels in double precision
    info.m_elasticRebound = false;      // found with factors in single precision
    btFemSoftBodySolver fem(info);
    SoftWorld world(fem, coupling);
    RigidSettings floor;
    floor.m_transform = at(btScalar(origin.x), btScalar(origin.y), btScalar(origin.z - 1));
    addRigidBox(world, {4, 4, 2}, floor);
    SoftBox box;
    box.m_size = {0.5, 0.5, 0.5};
    box.m_cells = {2, 2, 2};
    box.m_center = origin + Vec3{0, 0, 0.5};
    const btSoftBody& cube = addSoftBox(world, fem, box);
    world.step(60);
    std::vector<Vec3> places;
    for (int i = 0; i < cube.m_nodes.size(); ++i) places.push_back(vec3(cube.m_nodes[i].m_x) - origin);
    return places;
}

class Precision : public testing::TestWithParam<Coupling>
{
};

// The cube's rest shape and its positions are rounded by kEpsilon times the distance. Contact adds the solver's
// residual: the measured error is .4 (float) and 750 (double) times that; single precision anywhere in the double build
// would give 1e8 times.
TEST_P(Precision, DistantFallHasThePrecisionOfBullet)
{
    const Vec3 far{2048, -1024, 512};
    const double difference =
        largestDifference(placesAfterAFall({0, 0, 0}, GetParam()), placesAfterAFall(far, GetParam()));
    EXPECT_LT(difference, 800 * kEpsilon * norm(far));
}

INSTANTIATE_TEST_SUITE_P(Couplings, Precision, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& param) { return std::string(couplingName(param.param)); });

}  // namespace
}  // namespace bullet_fem
