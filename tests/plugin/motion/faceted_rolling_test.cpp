// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/cage/cage.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

// A body of few facets rolls from corner to corner, and a soft one is flattened: the contact area moves slower than the
// curvature of the rest shape predicts.

constexpr double kHalfEdge = 0.16;  // of an icosahedron [m]

SurfaceMesh icosahedron()
{
    const double a = kHalfEdge, b = a * (1 + std::sqrt(5.0)) / 2;
    return {{{-a, b, 0},
             {a, b, 0},
             {-a, -b, 0},
             {a, -b, 0},
             {0, -a, b},
             {0, a, b},
             {0, -a, -b},
             {0, a, -b},
             {b, 0, -a},
             {b, 0, a},
             {-b, 0, -a},
             {-b, 0, a}},
            {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
}

enum class Faceted
{
    solid,  // an icosahedron of twenty elements
    drawn,  // the icosahedron as render surface of a cage, with collision
    ball    // two elements along the radius
};

struct FacetedBody
{
    const char* m_name;
    Faceted m_shape;
    double m_youngModulus;  // [Pa]
    double m_speed;         // initial speed [m/s]
};

btSoftBody* makeFaceted(FemWorld& world, Faceted shape)
{
    if (shape == Faceted::ball) return btFemHelpers::createFromTetMesh(world.info(), makeSphere(0.3, 2));
    SurfaceMesh surface = icosahedron();
    if (shape == Faceted::drawn)
    {
        CageSettings settings;
        settings.m_cellSize = 0.1;
        settings.m_surfaceCollides = true;
        return btFemHelpers::createFromSurface(world.info(), surface, settings);
    }
    std::vector<Tet> tets;
    for (const Triangle& t : surface.m_triangles) tets.push_back({12, t[0], t[1], t[2]});
    surface.m_vertices.push_back({0, 0, 0});
    return btFemHelpers::createFromTetMesh(world.info(), TetMesh(surface.m_vertices, tets));
}

class FacetedRolling : public testing::TestWithParam<std::tuple<Coupling, FacetedBody>>
{
};

TEST_P(FacetedRolling, GainsNoEnergyAndEnds)
{
    const auto& [coupling, faceted] = GetParam();
    FemWorld world(WorldClass::softRigid, coupling);
    world.addFloorBox().setFriction(1);
    btSoftBody* made = makeFaceted(world, faceted.m_shape);
    made->rotate(btQuaternion(btVector3(btScalar(0.3), btScalar(0.2), btScalar(0.9)).normalized(), btScalar(0.7)));
    made->translate({0, 0, btScalar(0.31)});
    btFemMaterial material;
    material.m_youngModulus = btScalar(faceted.m_youngModulus);
    material.m_density = 1000;
    material.m_stiffnessDamping = btScalar(0.005);
    world.fem().setMaterial(made, material);
    btSoftBody& body = world.addSoft(made);
    body.setVelocity({btScalar(faceted.m_speed), btScalar(1.7 * faceted.m_speed), 0});
    const double mass = massOf(body);
    const auto energy = [&] { return motionOf(body).m_energy / mass + kGravity * centerOf(body).z; };
    const double begin = energy();
    double most = 0;
    for (int k = 0; k < 900; ++k)
    {
        world.step();
        most = std::max(most, energy());
    }
    EXPECT_LT(most, 1.01 * begin);
    EXPECT_LT(norm(velocityOf(body)), 0.1) << "after 15 s";
}

INSTANTIATE_TEST_SUITE_P(Bodies, FacetedRolling,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(FacetedBody{"Solid", Faceted::solid, 1e5, 1},
                                                          FacetedBody{"Drawn", Faceted::drawn, 3e5, 1},
                                                          FacetedBody{"DrawnRocking", Faceted::drawn, 1e4, 0},
                                                          FacetedBody{"Ball", Faceted::ball, 3e5, 3})),
                         [](const testing::TestParamInfo<std::tuple<Coupling, FacetedBody>>& test) {
                             return couplingName(std::get<0>(test.param)) + std::string(std::get<1>(test.param).m_name);
                         });

}  // namespace
}  // namespace bullet_fem
