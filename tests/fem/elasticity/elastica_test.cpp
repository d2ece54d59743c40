// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

// The load at the free end of an inextensible cantilever, in units of E I / L^2, and its transverse and axial
// deflection [Mattiasson 1981; integrating theta'' = -k cos theta gives these digits, too].
struct Elastica
{
    double m_load;
    double m_across;  // w / L [-]
    double m_along;   // u / L [-]
};

// The corotational bar follows the elastica through large rotations. 10 x 1 x 1 m, 8 cells through the thickness, nu 0:
// the mesh locks by 3.4 % (its linear deflection is .966 of Timoshenko's), shear adds 0.7 %, so that all loads stay
// within 5 %. At nu 0 the solution is constant across the width: two cells suffice.
TEST(ElasticityElasticaSlow, FollowsTheElasticaAtLargeDeflections)
{
    const double L = 10, E = 1e6, I = 1.0 / 12;
    const TetMesh mesh = makeBox({L, 1, 1}, {80, 2, 8});
    const std::vector<double> area = faceAreas(mesh, [L](const Vec3& X) { return X.x == L; });
    Body body = makeBody(
        mesh, elasticMaterial(E, 0, 1), [](const Vec3& X) { return X.x == 0; }, 1);
    for (const Elastica& exact :
         {Elastica{1, .30172, .05643}, Elastica{2, .49346, .16064}, Elastica{5, .71379, .38763}})
    {
        SCOPED_TRACE(exact.m_load);
        for (std::size_t i = 0; i < area.size(); ++i)
            body.m_loads.m_force[i].z = -exact.m_load * E * I / (L * L) * area[i];
        EXPECT_LE(relax(body, 1e-6 * L), 1e-6 * L);
        std::vector<Vec3> u = body.m_state.m_x;
        for (std::size_t i = 0; i < u.size(); ++i) u[i] -= mesh.restPositions()[i];
        const Vec3 end = weightedMean(area, u);
        EXPECT_NEAR(-end.z / L, exact.m_across, 0.05 * exact.m_across);
        EXPECT_NEAR(-end.x / L, exact.m_along, 0.05 * exact.m_along);
        EXPECT_NEAR(end.y / L, 0, 1e-3);
    }
}

}  // namespace
}  // namespace bullet_fem
