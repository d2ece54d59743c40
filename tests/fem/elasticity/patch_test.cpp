// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// States of constant strain, which linear tetrahedra hold exactly on any mesh: the patch test and the uniaxial bar.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/reference/warped_elements.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

// A box whose inner nodes are moved at random by up to a fifth of a cell, so that all elements differ.
TetMesh irregularBox(const Vec3& size, const std::array<int, 3>& cells, CellSplit split)
{
    const TetMesh regular = makeBox(size, cells, {}, split);
    std::vector<Vec3> X = regular.restPositions();
    std::vector<unsigned char> onSurface(X.size());
    for (int node : regular.surfaceNodes()) onSurface[node] = 1;
    RandomVectors random(5);
    for (std::size_t i = 0; i < X.size(); ++i)
    {
        const Vec3 r = random.next();
        if (!onSurface[i])
            X[i] += Vec3{0.2 * size.x / cells[0] * r.x, 0.2 * size.y / cells[1] * r.y, 0.2 * size.z / cells[2] * r.z};
    }
    return TetMesh(X, regular.tets());
}

struct Patch
{
    const char* m_name;
    CellSplit m_split;
    double m_poisson;
    double m_strain;
};

void PrintTo(const Patch& patch, std::ostream* out)
{
    *out << patch.m_name;
}

std::string patchName(const testing::TestParamInfo<Patch>& info)
{
    return info.param.m_name;
}

class ElasticityPatch : public testing::TestWithParam<Patch>
{
};

// The boundary is moved by u = G X with a full, unsymmetric G; the inner nodes take u = G X from any start. 1e-10
// relative to the largest displacement is the rounding of a converged Newton iteration in double precision.
TEST_P(ElasticityPatch, InteriorFollowsAnAffineBoundary)
{
    const Patch& p = GetParam();
    const Mat3 G = p.m_strain * Mat3{{{1, .5, -.3}, {-.2, -.7, .6}, {.4, .1, .8}}};
    const TetMesh mesh = irregularBox({1, 1, 1}, {4, 4, 4}, p.m_split);
    Body body = makeBody(
        mesh, elasticMaterial(1e6, p.m_poisson, 1),
        [](const Vec3& X) { return X.x == 0 || X.x == 1 || X.y == 0 || X.y == 1 || X.z == 0 || X.z == 1; }, 1);
    std::vector<Vec3> exact = mesh.restPositions();
    for (Vec3& x : exact) x += G * x;
    for (std::size_t i = 0; i < exact.size(); ++i)
        if (body.m_state.m_fixed[i]) body.m_state.m_x[i] = exact[i];
    const double moved = p.m_strain, still = 1e-11 * moved;  // [m]; 1e-15, rounding of positions, at the least
    EXPECT_LE(relax(body, still), still);
    EXPECT_LE(largestDistance(body.m_state.m_x, exact), 1e-10 * moved);
}

INSTANTIATE_TEST_SUITE_P(Strains, ElasticityPatch,
                         testing::Values(Patch{"FiveTetSmall", CellSplit::alternatingFive, .3, 1e-4},
                                         Patch{"FiveTet20Percent", CellSplit::alternatingFive, .3, .2},
                                         Patch{"KuhnSmall", CellSplit::kuhnSix, .3, 1e-4},
                                         Patch{"Kuhn20Percent", CellSplit::kuhnSix, .3, .2},
                                         Patch{"KuhnNearlyIncompressible", CellSplit::kuhnSix, .49, .2},
                                         Patch{"FiveTetOfLargestRatio", CellSplit::alternatingFive, .499, 1e-3}),
                         patchName);

constexpr double kPatchLength = 2, kSide = .5, kPatchYoung = 1e6;  // the bar [m], [m], [Pa]

bool onLeft(const Vec3& X)
{
    return X.x == 0;
}
bool onRight(const Vec3& X)
{
    return X.x == kPatchLength;
}

// x = (1 + eps) X along the bar and (1 - nu eps) X across.
std::vector<Vec3> uniaxialPositions(const TetMesh& mesh, const Patch& p)
{
    std::vector<Vec3> x = mesh.restPositions();
    const double along = 1 + p.m_strain, across = 1 - p.m_poisson * p.m_strain;
    for (Vec3& xi : x) xi = {along * xi.x, across * xi.y, across * xi.z};
    return x;
}

class ElasticityBar : public testing::TestWithParam<Patch>
{
protected:
    TetMesh m_mesh = irregularBox({kPatchLength, kSide, kSide}, {8, 3, 3}, GetParam().m_split);
    std::vector<Vec3> m_exact = uniaxialPositions(m_mesh, GetParam());
    double m_moved = kPatchLength * std::fabs(GetParam().m_strain);
    double m_force = kPatchYoung * kSide * kSide * GetParam().m_strain;  // E A (lambda - 1) [N]
};

// End sections are held in the exact state, sides are free: the inner nodes follow, and the end carries F = E A (lambda
// - 1) at each stretch, because the corotational stress is linear in it.
TEST_P(ElasticityBar, ReactionIsLinearInTheStretch)
{
    Body body = makeBody(
        m_mesh, elasticMaterial(kPatchYoung, GetParam().m_poisson, 1),
        [](const Vec3& X) { return onLeft(X) || onRight(X); }, 1);
    BodyState& s = body.m_state;
    for (std::size_t i = 0; i < s.m_x.size(); ++i) s.m_x[i] = s.m_fixed[i] ? m_exact[i] : s.m_x[i];
    EXPECT_LE(relax(body, 1e-11 * m_moved), 1e-11 * m_moved);
    EXPECT_LE(largestDistance(s.m_x, m_exact), 1e-10 * m_moved);

    std::vector<Vec3> force(s.m_x.size()), rest(s.m_x.size());
    addElasticForces(body.m_model->shape(), s.m_x, rest, 0, elementRotations(body), force, nullptr);
    Vec3 onEnd;
    for (std::size_t i = 0; i < force.size(); ++i)
        if (onRight(m_mesh.restPositions()[i])) onEnd += force[i];
    EXPECT_NEAR(onEnd.x, -m_force, 1e-9 * std::fabs(m_force));
    EXPECT_NEAR(onEnd.y, 0, 1e-9 * std::fabs(m_force));
    EXPECT_NEAR(onEnd.z, 0, 1e-9 * std::fabs(m_force));
}

INSTANTIATE_TEST_SUITE_P(Strains, ElasticityBar,
                         testing::Values(Patch{"FiveTetSmall", CellSplit::alternatingFive, .3, 1e-4},
                                         Patch{"FiveTetDoubled", CellSplit::alternatingFive, .3, 1},
                                         Patch{"KuhnSmall", CellSplit::kuhnSix, .3, 1e-4},
                                         Patch{"KuhnShortByTenth", CellSplit::kuhnSix, .3, -.1},
                                         Patch{"KuhnNearlyIncompressible", CellSplit::kuhnSix, .49, .2},
                                         Patch{"FiveTetWithoutPoisson", CellSplit::alternatingFive, 0, .5}),
                         patchName);

using ElasticityPulledBar = ElasticityBar;

// A free bar pulled at both ends by F, distributed by area, is longer by F L / (E A) and thinner by nu F / (E A). It
// may rotate slightly, so distances from its corners are compared.
TEST_P(ElasticityPulledBar, FreeBarTakesTheExactShape)
{
    // A short step: the torque of dead loads on a free body is explicit, so that h sqrt(F L / I) must stay below 1.
    Body body = makeBody(m_mesh, elasticMaterial(kPatchYoung, GetParam().m_poisson), {}, 1.0 / 60);
    const std::vector<double> left = faceAreas(m_mesh, onLeft), right = faceAreas(m_mesh, onRight);
    for (std::size_t i = 0; i < left.size(); ++i)
        body.m_loads.m_force[i].x = (right[i] - left[i]) / (kSide * kSide) * m_force;
    EXPECT_LE(relax(body, 1e-7 * m_moved), 1e-7 * m_moved);

    const std::vector<Vec3>& x = body.m_state.m_x;
    for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{kPatchLength, 0, 0}, Vec3{0, kSide, 0}, Vec3{0, 0, kSide}})
    {
        const int c = nodeAt(m_mesh, corner);
        double worst = 0;
        for (std::size_t i = 0; i < x.size(); ++i)
            worst = std::max(worst, std::fabs(norm(x[i] - x[c]) - norm(m_exact[i] - m_exact[c])));
        EXPECT_LE(worst, 1e-6 * m_moved);  // steps shrink by 0.6 to 0.9 each: ten times the last one
    }
}

INSTANTIATE_TEST_SUITE_P(Strains, ElasticityPulledBar,
                         testing::Values(Patch{"FiveTetSmall", CellSplit::alternatingFive, .3, .02},
                                         Patch{"KuhnLongByHalf", CellSplit::kuhnSix, .3, .5},
                                         Patch{"KuhnNearlyIncompressible", CellSplit::kuhnSix, .49, .2},
                                         Patch{"FiveTetWithoutPoisson", CellSplit::alternatingFive, 0, .2}),
                         patchName);

}  // namespace
}  // namespace bullet_fem
