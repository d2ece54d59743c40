// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Steps of orthotropic bodies: equal bits for any number of threads and after restoring a state, no allocation, and a
// factor of the orthotropic stiffness.
#include <gtest/gtest.h>

#include <cstring>

#include "bullet_fem/fem/batch/batch_memory.h"
#include "bullet_fem/fem/body/body_snapshot.h"
#include "bullet_fem/fem/common/threads.h"
#include "fem/batch/batched_solve.h"
#include "fem/scenes/elasticity_scenes.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

// Fibres that wind around x: a material per element.
ElementMaterials windingFibres(const TetMesh& mesh, double young = 1e6)
{
    std::vector<Material> perElement;
    for (const Tet& tet : mesh.tets())
    {
        Vec3 c;
        for (const int node : tet) c += 0.25 * mesh.restPositions()[node];
        Material material = elasticMaterial(1e5, 0.3);
        material.m_stiffnessDamping = 0.002;
        material.m_law = ElasticLaw::orthotropic;
        material.m_orthotropic = Orthotropic::transverselyIsotropic(young, 8e4, 0.3, 0.4, 5e4);
        material.m_orthotropic.m_along = {1, -(c.z - 0.5), c.y - 0.5};
        material.m_orthotropic.m_across = {0, 1, 0.3};
        perElement.push_back(material);
    }
    return ElementMaterials::ofElements(perElement);
}

class OrthotropicSteps : public testing::TestWithParam<double>  // tolerance
{
protected:
    OrthotropicSteps() { m_settings.m_tolerance = GetParam(); }

    Body body(std::array<int, 3> cells = {12, 6, 6}) const
    {
        const TetMesh mesh = makeBox({2, 1, 1}, cells);
        Body result = makeBody(mesh, windingFibres(mesh), [](const Vec3& X) { return X.x == 0; });
        setGravity(result, {0, 0, -9.81});
        for (std::size_t i = 0; i < result.m_state.m_v.size(); ++i)
        {
            const Vec3& x = result.m_state.m_x[i];
            result.m_state.m_v[i] = x.x * Vec3{0, -2 * x.z, 2 * x.y};
        }
        return result;
    }

    void run(Body& body, int steps)
    {
        m_impulses.resize(body.m_state.m_x.size());
        m_impulses.back() = {0, 1, 2};
        for (int k = 0; k < steps; ++k)
        {
            solveFreeMotion(body, m_settings);
            applyImpulses(body, m_impulses, m_settings);
            applyPositionCorrection(body, m_impulses, m_settings);
            finishStep(body, m_settings);
        }
    }

    static bool sameBits(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
    {
        return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0;
    }

    StepSettings m_settings;
    std::vector<Vec3> m_impulses;
};

TEST_P(OrthotropicSteps, HaveTheSameBitsForEveryNumberOfThreads)
{
    Body alone = body({20, 8, 8});
    run(alone, 6);
    for (const int count : {1, 2, 3, 8})
    {
        const Threads threads(count);
        m_settings.m_threads = &threads;
        Body shared = body({20, 8, 8});
        run(shared, 6);
        EXPECT_TRUE(sameBits(alone.m_state.m_x, shared.m_state.m_x)) << count;
        EXPECT_TRUE(sameBits(alone.m_state.m_v, shared.m_state.m_v)) << count;
    }
}

TEST_P(OrthotropicSteps, GoOnFromASavedState)
{
    Body first = body(), second = body();
    run(first, 5);
    const BodySnapshot saved = snapshotOf(first);
    run(first, 5);
    check(saved, *second.m_model);
    EXPECT_EQ(saved.m_shapeMark, markOf(second.m_model->shape()));
    restore(saved, second);
    run(second, 5);
    EXPECT_TRUE(sameBits(first.m_state.m_x, second.m_state.m_x));
    const TetMesh& mesh = first.m_model->mesh();
    EXPECT_NE(saved.m_shapeMark, markOf(RestShape(mesh, windingFibres(mesh, 1.1e6))));
    ElementMaterials turned = windingFibres(mesh);
    turned.m_regions[7].m_material.m_orthotropic.m_across = {0, 0, 1};
    EXPECT_NE(saved.m_shapeMark, markOf(RestShape(mesh, turned)));
    EXPECT_NE(markOf(windingFibres(mesh)), markOf(turned));
}

TEST_P(OrthotropicSteps, AllocateNoMemory)
{
    Body hung = body();
    run(hung, 1);  // the first step in double precision allocates
    const AllocationCounter counter;
    run(hung, 5);
    EXPECT_EQ(counter.count(), 0);
}

// The factor uses the body's own C: few iterations at any stiffness of the fibres.
TEST_P(OrthotropicSteps, TakeFewIterationsWithTheirFactor)
{
    const TetMesh mesh = makeBox({2, 1, 1}, {12, 6, 6});
    for (const double young : {1e5, 1e6, 1e7})
    {
        Body hung = makeBody(mesh, windingFibres(mesh, young), [](const Vec3& X) { return X.x == 0; });
        setGravity(hung, {0, 0, -1});
        int iterations = 0;
        for (int k = 0; k < 20; ++k) iterations += step(hung, m_settings).m_iterations;
        EXPECT_LE(iterations, GetParam() > 1e-4 ? 3 * 20 : 12 * 20) << young;
    }
}

INSTANTIATE_TEST_SUITE_P(Tolerances, OrthotropicSteps, testing::Values(1e-3, 1e-6),
                         [](const auto& suite) { return std::string(suite.param > 1e-4 ? "Single" : "Double"); });

// They are solved one by one: batched kernels are for Hooke's law only.
TEST(OrthotropicBodies, AreNotSolvedSideBySide)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {2, 2, 2});
    BatchMemory memory;
    StepSettings settings;
    settings.m_batchMemory = &memory;
    Body plain = makeBody(mesh, elasticMaterial(1e5, 0.3)), fibrous = makeBody(mesh, windingFibres(mesh));
    EXPECT_TRUE(canBeBatched(FreeMotion{&plain, settings, {}}));
    EXPECT_FALSE(canBeBatched(FreeMotion{&fibrous, settings, {}}));
}

// The mismatch is given as an equivalent ratio of steps: a C of four times the stiffness counts as two.
TEST(OrthotropicBodies, TellHowStaleAFactorIs)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {2, 2, 2});
    const auto materials = [&](double scale)
    {
        ElementMaterials result = windingFibres(mesh);
        for (MaterialRegion& region : result.m_regions)
        {
            Orthotropic& m = region.m_material.m_orthotropic;
            for (auto* constants : {&m.m_young, &m.m_shear})
                for (double& value : *constants) value *= scale;
        }
        return result;
    };
    const Body body = makeBody(mesh, materials(1));
    const auto mismatch = [&](const ElementMaterials& other)
    {
        return BodyModel::withFactor(std::make_shared<const RestShape>(mesh, other), body.m_model->sharedFactor())
            ->materialMismatch();
    };
    EXPECT_EQ(mismatch(materials(1)), 1);
    EXPECT_NEAR(mismatch(materials(4)), 2, 1e-9);
    EXPECT_NEAR(mismatch(materials(1 / 9.0)), 3, 1e-9);
    EXPECT_GT(mismatch(elasticMaterial(8e4, 0.3)), 2);
}

}  // namespace
}  // namespace bullet_fem
