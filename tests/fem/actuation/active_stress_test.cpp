// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Activated fibres and expanding elements: stress and strain against closed formulas.
#include "bullet_fem/fem/body/active_stress.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_fem/fem/body/initial_stress.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/expect_rejected.h"

namespace bullet_fem
{
namespace
{

const double kYoung = 1e5;

Body freeBar(double poisson = 0.3)
{
    return makeBody(makeBox({1, 0.2, 0.2}, {8, 2, 2}), elasticMaterial(kYoung, poisson), {}, 1);
}

// Deformation gradient F of a uniformly strained body, from the edges at one corner.
Mat3 stretchOf(const Body& body)
{
    const TetMesh& mesh = body.m_model->mesh();
    const int origin = nodeAt(mesh, {0, 0, 0});
    const int ends[3] = {nodeAt(mesh, {1, 0, 0}), nodeAt(mesh, {0, 0.2, 0}), nodeAt(mesh, {0, 0, 0.2})};
    const std::vector<Vec3>&x = body.m_state.m_x, &X = mesh.restPositions();
    Vec3 columns[3];
    for (int c = 0; c < 3; ++c) columns[c] = (1 / norm(X[ends[c]] - X[origin])) * (x[ends[c]] - x[origin]);
    return Mat3::fromColumns(columns[0], columns[1], columns[2]);
}

// --- Fibres ---

// Hooke's law: a free body gets the strain -(a / E) ((1 + nu) f f^T - nu I).
TEST(ActivatedFibres, DrawAFreeBarTogetherAlongThem)
{
    const double a = 0.02 * kYoung, nu = 0.3;
    for (const Vec3& f : {Vec3{1, 0, 0}, Vec3{0, 0, -3}, Vec3{2, 1, 0.5}})
    {
        Body body = freeBar(nu);
        body.m_actuators.m_fibres = {{1, {}, {f}, a}};
        applyActiveStress(body);
        EXPECT_LE(relax(body, 1e-9), 1e-9);
        const Mat3 F = stretchOf(body), C = transposeTimes(F, F);
        const Mat3 strain = -a / kYoung * ((1 + nu) / dot(f, f) * outer(f, f) - Mat3::diagonal(nu)),
                   U = Mat3::identity() + strain;
        EXPECT_LE(std::sqrt(squaredNorm(C - U * U)), 1e-5);
    }
}

// Fibres in one region: its elements shorten, the others do not.
TEST(ActivatedFibres, ActInTheirRegion)
{
    Body body = makeBody(makeBox({1, 0.2, 0.2}, {8, 2, 2}), elasticMaterial(kYoung, 0), {}, 1);
    const TetMesh& mesh = body.m_model->mesh();
    Fibres fibres;
    fibres.m_directions = {{1, 0, 0}};
    fibres.m_activation = 0.02 * kYoung;
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        Vec3 middle;
        for (const int node : mesh.tets()[e]) middle += 0.25 * mesh.restPositions()[node];
        if (middle.x > 0.5) fibres.m_elements.push_back(e);
    }
    body.m_actuators.m_fibres = {fibres};
    applyActiveStress(body);
    EXPECT_LE(relax(body, 1e-9), 1e-9);
    const auto x = [&](double X) { return body.m_state.m_x[nodeAt(mesh, {X, 0, 0})].x; };
    EXPECT_NEAR(x(0.5) - x(0), 0.5, 1e-6);
    EXPECT_NEAR(x(1) - x(0.5), 0.5 * 0.98, 1e-6);
}

TEST(ActivatedFibres, MayHaveOneDirectionPerElement)
{
    Body body = freeBar();
    const int count = body.m_model->mesh().tetCount();
    Fibres fibres;
    for (int e = 0; e < count; ++e) fibres.m_directions.push_back(e % 2 ? Vec3{1, 0, 0} : Vec3{0, 2, 0});
    fibres.m_activation = 7;
    body.m_actuators.m_fibres = {fibres};
    applyActiveStress(body);
    const std::vector<SymmetricTensor>& stress = body.m_state.m_initialStress;
    for (int e = 0; e < count; ++e)
        EXPECT_EQ(stress[e], e % 2 ? (SymmetricTensor{7, 0, 0, 0, 0, 0}) : (SymmetricTensor{0, 7, 0, 0, 0, 0}));
}

// --- Expansion ---

TEST(Expansion, FreeBodyStretchesByTheGivenStrain)
{
    for (const double nu : {0.0, 0.3, 0.45})  // the last one with patches (mean dilatation)
        for (const double strain : {-0.05, 0.01, 0.5})
        {
            Body body = freeBar(nu);
            body.m_actuators.m_expansions = {{1, {}, strain}};
            applyActiveStress(body);
            EXPECT_LE(relax(body, 1e-8), 1e-8);
            const Mat3 F = stretchOf(body), C = transposeTimes(F, F);
            EXPECT_LE(std::sqrt(squaredNorm(C - Mat3::diagonal((1 + strain) * (1 + strain)))), 1e-5);
        }
}

// [Timoshenko 1925, eq. 4] for two layers of equal thickness and material: curvature = 3/2 strain / total thickness.
double bilayerCurvature(const std::function<void(Body&, const std::vector<int>& upper)>& drive)
{
    const double thickness = 0.04;
    const int cells = 8;
    Body body = makeBody(makeBox({0.16, 0.02, thickness}, {4 * cells, 4, cells}), elasticMaterial(kYoung, 0), {}, 0.1);
    const TetMesh& mesh = body.m_model->mesh();
    std::vector<int> upper;
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        Vec3 middle;
        for (const int node : mesh.tets()[e]) middle += 0.25 * mesh.restPositions()[node];
        if (middle.z > thickness / 2) upper.push_back(e);
    }
    drive(body, upper);
    applyActiveStress(body);
    EXPECT_LE(relax(body, 1e-9), 1e-9);
    // The circle through three points of the middle line.
    const Vec3 a = body.m_state.m_x[nodeAt(mesh, {0.04, 0.01, 0.02})],
               b = body.m_state.m_x[nodeAt(mesh, {0.08, 0.01, 0.02})],
               c = body.m_state.m_x[nodeAt(mesh, {0.12, 0.01, 0.02})];
    return 2 * norm(cross(b - a, c - a)) / (norm(b - a) * norm(c - b) * norm(c - a));
}

TEST(Expansion, BendsABimetalFromOneLayer)
{
    const double strain = 0.01, curvature = 1.5 * strain / 0.04;
    const double found = bilayerCurvature(
        [&](Body& body, const std::vector<int>& upper) {
            body.m_actuators.m_expansions = {{1, upper, strain}};
        });
    EXPECT_NEAR(found, curvature, 0.05 * curvature);
}

TEST(ActivatedFibres, BendABilayerFromOneLayer)
{
    const double a = 0.01 * kYoung, curvature = 1.5 * 0.01 / 0.04;
    const double found = bilayerCurvature(
        [&](Body& body, const std::vector<int>& upper) {
            body.m_actuators.m_fibres = {{1, upper, {{1, 0, 0}}, a}};
        });
    EXPECT_NEAR(found, curvature, 0.05 * curvature);
}

// --- Together ---

TEST(ActiveStress, IsAddedToTheBodysOwn)
{
    Body body = freeBar(0);
    const SymmetricTensor own = {1, 2, 3, 4, 5, 6};
    const std::size_t count = body.m_model->mesh().tets().size();
    body.m_actuators.m_ownStress.assign(count, own);
    body.m_actuators.m_fibres = {{1, {}, {{1, 0, 0}}, 10}, {2, {0}, {{0, 1, 0}}, 100}};
    body.m_actuators.m_expansions = {{3, {0}, -0.03}};
    applyActiveStress(body);
    const double pressure = 0.03 * kYoung;  // K = E / 3
    const SymmetricTensor first = body.m_state.m_initialStress[0];
    EXPECT_NEAR(first.xx, 1 + 10 + pressure, 1e-9);
    EXPECT_NEAR(first.yy, 2 + 100 + pressure, 1e-9);
    EXPECT_NEAR(first.zz, 3 + pressure, 1e-9);
    EXPECT_EQ(first.xy, 4);
    EXPECT_EQ(body.m_state.m_initialStress[1], (SymmetricTensor{11, 2, 3, 4, 5, 6}));
    body.m_actuators.m_fibres.clear();
    body.m_actuators.m_expansions.clear();
    applyActiveStress(body);
    EXPECT_EQ(body.m_state.m_initialStress, body.m_actuators.m_ownStress);
    body.m_actuators.m_ownStress.clear();
    applyActiveStress(body);
    EXPECT_TRUE(body.m_state.m_initialStress.empty());
}

TEST(ActiveStress, RejectsInvalidInput)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {1, 1, 1});
    const auto fibres = [&](const Fibres& f, const char* part) { expectRejected([&] { f.validate(mesh); }, {part}); };
    fibres({1, {}, {}, 1}, "have 0 directions for 5 elements; give one for all, or one each");
    fibres({1, {0, 1, 2}, {{1, 0, 0}, {1, 0, 0}}, 1}, "have 2 directions for 3 elements");
    fibres({1, {5}, {{1, 0, 0}}, 1}, "element 5 of the fibres is not in [0, 5)");
    fibres({1, {-1}, {{1, 0, 0}}, 1}, "element -1 of the fibres");
    fibres({1, {}, {{0, 0, 0}}, 1}, "a fibre's direction is (0, 0, 0)");
    fibres({1, {}, {{std::nan(""), 0, 0}}, 1}, "of a length not in (0, inf)");
    for (const double a : {std::nan(""), 1.1e13, -HUGE_VAL})
        fibres({1, {}, {{1, 0, 0}}, a}, "the fibres' activation is");
    Fibres{1, {}, {{1, 0, 0}}, -1e13}.validate(mesh);
    Expansion{1, {}, -0.9}.validate(mesh);
    Expansion{1, {}, 9}.validate(mesh);
    for (const double strain : {std::nan(""), -0.91, 9.1})
        expectRejected([&] { (Expansion{1, {}, strain}).validate(mesh); }, {"the expansion's strain is"});
    expectRejected([&] { (Expansion{1, {7}, 0}).validate(mesh); }, {"element 7 of the expansion is not in [0, 5)"});
}

}  // namespace
}  // namespace bullet_fem
