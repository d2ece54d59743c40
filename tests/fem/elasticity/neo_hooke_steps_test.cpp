// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Steps of Neo-Hookean bodies: no element stays inverted, energy falls, and results are bitwise equal for all ways to
// step (docs/materials.md, Large strain).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/batch/batch_memory.h"
#include "bullet_fem/fem/body/body_snapshot.h"
#include "bullet_fem/fem/common/threads.h"
#include "fem/scenes/stepping_scenes.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

constexpr double kMovedYoung = 1e6;  // [Pa]

Material movedNeoHookean(double nu = 0.3, double young = kMovedYoung)
{
    Material material = elasticMaterial(young, nu);
    material.m_law = ElasticLaw::neoHooke;
    return material;
}

void takeNeoHookeSteps(Body& body, int steps, const StepSettings& settings = {})
{
    for (int k = 0; k < steps; ++k) bullet_fem::step(body, settings);
}

struct NeoHookeStep
{
    double m_nu, m_damping;
};

class NeoHookeSteps : public testing::TestWithParam<NeoHookeStep>
{
protected:
    StepSettings settings() const
    {
        StepSettings settings;
        settings.m_numericalDamping = GetParam().m_damping;
        return settings;
    }
};

// Top and bottom faces are moved together to a tenth of the height, held, and released.
TEST_P(NeoHookeSteps, ACrushedCubeRecovers)
{
    Material material = movedNeoHookean(GetParam().m_nu, 1e5);
    material.m_stiffnessDamping = 0.01;
    const auto isEnd = [](const Vec3& X) { return X.y < 1e-9 || X.y > 1 - 1e-9; };
    Body cube = makeBody(makeBox({1, 1, 1}, {4, 4, 4}), material, isEnd);
    const std::vector<Vec3>& X = cube.m_model->mesh().restPositions();
    for (int k = 0; k < 120; ++k)
    {
        for (std::size_t i = 0; i < X.size(); ++i)
            if (isEnd(X[i])) cube.m_loads.m_targetVelocity[i] = {0, k < 60 ? 0.9 * (0.5 - X[i].y) : 0, 0};
        EXPECT_EQ(bullet_fem::step(cube, settings()).m_stop, SolveStop::converged) << k;
        EXPECT_GT(smallestVolumeRatio(cube), 0.05) << k;
    }
    const std::vector<Vec3>& x = cube.m_state.m_x;
    ASSERT_NEAR(x[nodeAt(cube.m_model->mesh(), {0, 1, 0})].y - x[nodeAt(cube.m_model->mesh(), {0, 0, 0})].y, 0.1, 1e-6);
    std::fill(cube.m_state.m_fixed.begin(), cube.m_state.m_fixed.end(), static_cast<unsigned char>(0));
    for (int k = 0; k < 400; ++k)
    {
        bullet_fem::step(cube, settings());
        EXPECT_GT(smallestVolumeRatio(cube), 0.05) << k;
    }
    for (std::size_t i = 0; i < X.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) EXPECT_NEAR(norm(x[i] - x[j]), norm(X[i] - X[j]), 1e-3);
}

enum class WildStart
{
    mirrored,
    flat,
    stretched,
    kicked
};

Body wildBody(WildStart start, const Material& material)
{
    const auto isEnd = [](const Vec3& X) { return X.y < 1e-9 || X.y > 1 - 1e-9; };
    Body body = makeBody(makeBox({1, 1, 1}, {4, 4, 4}), material,
                         start == WildStart::stretched ? NodePredicate(isEnd) : NodePredicate());
    const std::vector<Vec3>& X = body.m_model->mesh().restPositions();
    RandomVectors random(7);
    for (std::size_t i = 0; i < X.size(); ++i)
    {
        if (start == WildStart::mirrored) body.m_state.m_x[i] = {X[i].x, -X[i].y, X[i].z};
        if (start == WildStart::flat) body.m_state.m_x[i] = {X[i].x, 0, X[i].z};
        if (start == WildStart::stretched) body.m_state.m_x[i] = {X[i].x, 2 * X[i].y, X[i].z};
        if (start == WildStart::stretched && !isEnd(X[i])) body.m_state.m_v[i] = 10.0 * random.next();
        if (start == WildStart::kicked) body.m_state.m_v[i] = 10.0 * random.next();
    }
    return body;
}

// From any deformation, with velocities that would carry nodes through each other.
TEST_P(NeoHookeSteps, EnergyStaysBelowThatOfTheStart)
{
    for (const WildStart start : {WildStart::mirrored, WildStart::flat, WildStart::stretched, WildStart::kicked})
        for (const double young : {1e4, 1e6})
        {
            Body body = wildBody(start, movedNeoHookean(GetParam().m_nu, young));
            const double before = mechanicalEnergy(body);
            double least = before, rise = 0, most = 0;
            for (int k = 0; k < 200; ++k)
            {
                bullet_fem::step(body, settings());
                const double now = mechanicalEnergy(body);
                rise = std::max(rise, now - least);
                least = std::min(least, now);
                most = std::max(most, now);
            }
            EXPECT_LE(most, 1.001 * before) << static_cast<int>(start) << ", " << young;
            EXPECT_LE(rise, 0.1 * before) << static_cast<int>(start) << ", " << young;
        }
}

// Flat and inverted elements recover; the material is damped, so that the body comes to rest.
TEST_P(NeoHookeSteps, NoElementStaysInsideOut)
{
    for (const WildStart start : {WildStart::mirrored, WildStart::flat, WildStart::kicked})
    {
        Material material = movedNeoHookean(GetParam().m_nu, 1e5);
        material.m_stiffnessDamping = 0.01;
        Body body = wildBody(start, material);
        for (int k = 0; k < 400; ++k) bullet_fem::step(body, settings());
        EXPECT_GT(smallestVolumeRatio(body), 0.95) << static_cast<int>(start);
    }
}

INSTANTIATE_TEST_SUITE_P(Steps, NeoHookeSteps,
                         testing::Values(NeoHookeStep{0, 1}, NeoHookeStep{0.3, 1}, NeoHookeStep{0.45, 1},
                                         NeoHookeStep{0, 0}, NeoHookeStep{0.3, 0}, NeoHookeStep{0.45, 0}),
                         [](const auto& step)
                         {
                             return "nu" + std::to_string(static_cast<int>(100 * step.param.m_nu)) +
                                    (step.param.m_damping > 0 ? "_Euler" : "_SecondOrder");
                         });

// The cube of Bullet's VolumetricDeformable, E 50 Pa, under one and two of its boxes, whose weight is E times their
// face: under Hooke's law elements would invert.
TEST(NeoHooke, BoxesAsHeavyAsEPressNoElementInsideOut)
{
    for (const double boxes : {1.0, 2.0})
        for (const ElasticLaw law : {ElasticLaw::hooke, ElasticLaw::neoHooke})
        {
            Material material = elasticMaterial(50, 0.3, 0.5 / 64);  // half a kilogram
            material.m_law = law;
            material.m_stiffnessDamping = 0.01;
            material.m_massDamping = 0.1;
            StepSettings settings;
            settings.m_step = 1.0 / 240;
            Body cube = makeBody(
                makeBox({4, 4, 4}, {4, 4, 4}), material, [](const Vec3& X) { return X.y < 1e-9; }, settings.m_step);
            setGravity(cube, {0, -100, 0});
            const std::vector<double> face =
                faceAreas(cube.m_model->mesh(), [](const Vec3& X)
                          { return X.y > 4 - 1e-9 && std::fabs(X.x - 2) < 1.1 && std::fabs(X.z - 2) < 1.1; });
            for (std::size_t i = 0; i < face.size(); ++i) cube.m_loads.m_force[i].y -= boxes * 50 * face[i];
            takeNeoHookeSteps(cube, 2400, settings);
            for (const Vec3& v : cube.m_state.m_v) ASSERT_LT(norm(v), 1e-4);
            EXPECT_EQ(smallestVolumeRatio(cube) > 0.1, law == ElasticLaw::neoHooke) << smallestVolumeRatio(cube);
        }
}

// For a free undamped body momentum is exact at any strain.
TEST(NeoHooke, MomentumIsExact)
{
    Body body = makeBody(makeBox({1, 0.6, 0.5}, {4, 3, 3}), movedNeoHookean());
    disturb(body);
    std::fill(body.m_loads.m_force.begin(), body.m_loads.m_force.end(), Vec3());
    for (Vec3& v : body.m_state.m_v) v *= 20;  // includes quasi-Newton corrections
    const Vec3 p = linearMomentum(body.m_state), L = angularMomentum(body.m_state);
    for (int k = 0; k < 50; ++k) bullet_fem::step(body, StepSettings());
    EXPECT_LE(norm(linearMomentum(body.m_state) - p), 1e-10 * norm(L));
    EXPECT_LE(norm(angularMomentum(body.m_state) - L), 1e-10 * norm(L));
}

bool isSameMotion(const Body& a, const Body& b)
{
    return largestDistance(a.m_state.m_x, b.m_state.m_x) == 0 && largestDistance(a.m_state.m_v, b.m_state.m_v) == 0;
}

Body disturbedNeoHookean(const std::shared_ptr<const BodyModel>& model)
{
    Body body(model);
    disturb(body);
    for (Vec3& v : body.m_state.m_v) v *= 20;  // includes quasi-Newton corrections
    return body;
}

class NeoHookeBits : public testing::TestWithParam<int>
{
};

TEST_P(NeoHookeBits, AreTheSameForAllThreadCounts)
{
    const Body model = makeBody(makeBox({1, 0.5, 0.5}, {20, 8, 8}), movedNeoHookean());
    for (const double damping : {1.0, 0.0})
    {
        Body one = disturbedNeoHookean(model.m_model), many = disturbedNeoHookean(model.m_model);
        const Threads threads(GetParam());
        StepSettings settings;
        settings.m_numericalDamping = damping;
        takeNeoHookeSteps(one, 3, settings);
        settings.m_threads = &threads;
        takeNeoHookeSteps(many, 3, settings);
        EXPECT_TRUE(isSameMotion(one, many));
    }
}
INSTANTIATE_TEST_SUITE_P(Threads, NeoHookeBits, testing::Values(1, 2, 3, 8));

TEST(NeoHooke, IsRestored)
{
    const Body model = makeBody(makeBox({1, 0.5, 0.5}, {4, 2, 2}), movedNeoHookean());
    Body body = disturbedNeoHookean(model.m_model), other(model.m_model);
    takeNeoHookeSteps(body, 5);
    const BodySnapshot snapshot = snapshotOf(body);
    check(snapshot, *other.m_model);
    restore(snapshot, other);
    other.m_loads = body.m_loads;
    takeNeoHookeSteps(body, 20), takeNeoHookeSteps(other, 20);
    EXPECT_TRUE(isSameMotion(body, other));
    EXPECT_NE(markOf(ElementMaterials(movedNeoHookean())), markOf(ElementMaterials(elasticMaterial(kMovedYoung, 0.3))));
}

TEST(NeoHooke, IsBaked)
{
    BakeSettings settings;
    settings.m_material = movedNeoHookean();
    const BakedBody body = bakeBody(makeBox({1, 1, 1}, {2, 2, 2}), settings);
    const std::string path = testing::TempDir() + "neo_hooke.bfem";
    writeBakedBody(path, body);
    const BakedBody read = readBakedBody(path);
    std::remove(path.c_str());
    EXPECT_TRUE(read.m_model->shape().m_materials == body.m_model->shape().m_materials);
    EXPECT_EQ(read.m_model->shape().m_material.m_law, ElasticLaw::neoHooke);
}

TEST(NeoHooke, BatchedStepsHaveTheSameBits)
{
    const Body model = makeBody(makeBox({1, 0.5, 0.5}, {4, 2, 2}), movedNeoHookean());
    std::vector<Body> together;
    for (int k = 0; k < 8; ++k) together.push_back(disturbedNeoHookean(model.m_model));
    Body alone = disturbedNeoHookean(model.m_model);
    BatchMemory memory;
    StepSettings settings;
    settings.m_batchMemory = &memory;
    for (int k = 0; k < 5; ++k)
    {
        std::vector<FreeMotion> motions;
        std::vector<StepEnd> ends;
        for (Body& body : together) motions.push_back({&body, settings, {}}), ends.push_back({&body, settings, false});
        solveFreeMotions(motions.data(), static_cast<int>(motions.size()));
        finishSteps(ends.data(), static_cast<int>(ends.size()));
        bullet_fem::step(alone, StepSettings());
    }
    for (const Body& body : together) EXPECT_TRUE(isSameMotion(body, alone));
}

TEST(NeoHooke, StepsDoNotAllocate)
{
    const Body model = makeBody(makeBox({1, 0.5, 0.5}, {4, 2, 2}), movedNeoHookean());
    Body body = disturbedNeoHookean(model.m_model);
    takeNeoHookeSteps(body, 1);
    const AllocationCounter counter;
    takeNeoHookeSteps(body, 5);
    EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace bullet_fem
