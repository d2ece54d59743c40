// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// What the two precisions of Bullet differ in: digits far from the origin.
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

/// Places of the nodes from `origin` [m], a second after a soft cube was let go there over a box that stands still.
/// Nothing else is there, so that it must not matter where that is.
std::vector<Vec3> placesAfterAFall(const Vec3& origin, Coupling coupling)
{
    btFemSolverInfo info;
    info.m_tolerance = btScalar(1e-8);  // elements in double
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

// The cube's shape is rounded to where it stands, by kEpsilon of the distance, and so are its places. Contact adds to
// it what the linear solves leave: measured .3 (float) and 80 (double) times that;
// single precision anywhere in the double build would be 1e8 times.
TEST_P(Precision, DistantFallHasThePrecisionOfBullet)
{
    const Vec3 far{2048, -1024, 512};
    const double difference =
        largestDifference(placesAfterAFall({0, 0, 0}, GetParam()), placesAfterAFall(far, GetParam()));
    EXPECT_LT(difference, 400 * kEpsilon * norm(far));
}

INSTANTIATE_TEST_SUITE_P(Couplings, Precision, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& param) { return std::string(couplingName(param.param)); });

}  // namespace
}  // namespace bullet_fem
