// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/baked/baked_body.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/factor/rest_factor.h"
#include "fem/scenes/baked_files.h"
#include "fem/scenes/expect_rejected.h"

namespace bullet_fem
{
namespace
{

// Node coordinates after a second under gravity.
std::vector<double> coordinatesAfterFalling(const BakedBody& baked)
{
    Body body(baked.m_model);
    StepSettings settings;
    for (int i = 0; i < baked.m_model->nodeCount(); ++i)
        body.m_loads.m_force[i] = {1, 0, -9.81 * body.m_state.m_mass[i]};
    for (int k = 0; k < 60; ++k) step(body, settings);
    std::vector<double> coordinates;
    for (const Vec3& x : body.m_state.m_x) coordinates.insert(coordinates.end(), {x.x, x.y, x.z});
    return coordinates;
}

void expectSame(const BakedBody& a, const BakedBody& b)
{
    const BodyModel &m = *a.m_model, &n = *b.m_model;
    EXPECT_EQ(a.m_inverseMass, b.m_inverseMass);
    EXPECT_EQ(a.m_filled, b.m_filled);
    EXPECT_EQ(a.m_massScale, b.m_massScale);
    EXPECT_EQ(a.m_triangles, b.m_triangles);
    EXPECT_EQ(a.m_singlePrecision, b.m_singlePrecision);
    ASSERT_EQ(a.m_embedding.size(), b.m_embedding.size());
    for (std::size_t v = 0; v < a.m_embedding.size(); ++v)
    {
        EXPECT_EQ(a.m_embedding[v].m_tet, b.m_embedding[v].m_tet);
        EXPECT_EQ(a.m_embedding[v].m_weights, b.m_embedding[v].m_weights);
    }
    EXPECT_EQ(m.mesh().tets(), n.mesh().tets());
    EXPECT_EQ(m.mesh().surface(), n.mesh().surface());
    EXPECT_EQ(m.mesh().surfaceNodes(), n.mesh().surfaceNodes());
    EXPECT_EQ(m.shape().m_material, n.shape().m_material);
    EXPECT_EQ(m.factorInput(), n.factorInput());
    EXPECT_EQ(m.factorReport().m_path, n.factorReport().m_path);
    EXPECT_EQ(m.factorReport().m_backend, n.factorReport().m_backend);
    EXPECT_EQ(m.factorReport().m_ordering, n.factorReport().m_ordering);
    EXPECT_EQ(m.factorReport().m_entries, n.factorReport().m_entries);
    EXPECT_EQ(m.factorReport().m_bytes, n.factorReport().m_bytes);
    EXPECT_EQ(m.factorReport().m_fullBytes, n.factorReport().m_fullBytes);
}

class BakedBodies : public testing::TestWithParam<BakedCase>
{
protected:
    const BakedBody m_baked = bakeCase(GetParam());
    const TemporaryFolder m_folder;
    const std::string m_path = m_folder.path("body.bfem");
};

TEST_P(BakedBodies, AreReadAsTheyWere)
{
    writeBakedBody(m_path, m_baked);
    const std::string bytes = m_folder.read("body.bfem");
    for (const BakedBody& read : {readBakedBody(m_path), readBakedBody(m_path, BakedLoading::copied),
                                  readBakedBody(rawBytes(bytes), bytes.size(), "archive")})
    {
        expectSame(read, m_baked);
        EXPECT_TRUE(read.m_model->factorReport().m_baked);
        EXPECT_EQ(coordinatesAfterFalling(read), coordinatesAfterFalling(m_baked));
    }
    EXPECT_FALSE(m_baked.m_model->factorReport().m_baked);
}

TEST_P(BakedBodies, GiveTheSameBytesEveryTime)
{
    EXPECT_EQ(bytesOf(m_baked), bytesOf(m_baked));
    EXPECT_EQ(bytesOf(bakeCase(GetParam())), bytesOf(m_baked));
    writeBakedBody(m_path, m_baked);
    EXPECT_EQ(bytesOf(readBakedBody(m_path)), bytesOf(m_baked));
}

TEST_P(BakedBodies, AreDescribedByTheirHeader)
{
    writeBakedBody(m_path, m_baked);
    const BakedFileInfo info = inspectBakedBody(m_path);
    const BodyModel& model = *m_baked.m_model;
    EXPECT_EQ(info.m_version, 2);
    EXPECT_EQ(info.m_fileBytes, std::filesystem::file_size(m_path));
    EXPECT_EQ(info.m_factorBytes, model.factorReport().m_bytes);
    EXPECT_EQ(info.m_nodes, model.nodeCount());
    EXPECT_EQ(info.m_tets, model.mesh().tetCount());
    EXPECT_EQ(info.m_freeNodes, model.nodeCount() - 2);
    EXPECT_EQ(info.m_embeddedVertices, static_cast<int>(m_baked.m_embedding.size()));
    EXPECT_EQ(info.m_embeddedTriangles, static_cast<int>(m_baked.m_triangles.size()));
    EXPECT_EQ(info.m_material, model.shape().m_material);
    EXPECT_EQ(info.m_step, model.factorInput().m_step);
    EXPECT_EQ(info.m_factor.m_path,
              GetParam().m_choice == FactorChoice::full ? FactorPath::full : FactorPath::lowMemory);
    EXPECT_EQ(info.m_factor.m_backend, model.factorReport().m_backend);
}

TEST_P(BakedBodies, NeedTheirFileNoMoreWhenItIsReplacedOrRemoved)
{
    writeBakedBody(m_path, m_baked);
    const BakedBody read = readBakedBody(m_path);
    writeBakedBody(m_path, bakeCase({{1, 1, 1}, FactorChoice::full, false}));
    const std::vector<double> replaced = coordinatesAfterFalling(read);
    std::filesystem::remove(m_path);
    EXPECT_EQ(coordinatesAfterFalling(read), coordinatesAfterFalling(m_baked));
    EXPECT_EQ(replaced, coordinatesAfterFalling(m_baked));
}

INSTANTIATE_TEST_SUITE_P(Of, BakedBodies,
                         testing::Values(BakedCase{{4, 3, 3}, FactorChoice::full, true},
                                         BakedCase{{4, 3, 3}, FactorChoice::lowMemory, true},
                                         BakedCase{{16, 8, 8}, FactorChoice::full, false}),
                         [](const auto& param)
                         {
                             const BakedCase& c = param.param;
                             return std::string(c.m_surface ? "ACage" : "ABoxWithSubtrees") +
                                    (c.m_choice == FactorChoice::full ? "" : "OfLowMemory");
                         });

TEST(Baking, KeepsWhetherElementsShareTheirVolumeChange)
{
    const TemporaryFolder folder;
    for (const MeanDilatation choice : {MeanDilatation::automatic, MeanDilatation::on, MeanDilatation::off})
    {
        BakeSettings settings;
        settings.m_material.m_poissonRatio = 0.45;
        settings.m_material.m_meanDilatation = choice;
        const BakedBody baked = bakeBody(makeBox({1, 1, 1}, {2, 2, 2}), settings);
        writeBakedBody(folder.path("body.bfem"), baked);
        const BakedBody read = readBakedBody(folder.path("body.bfem"));
        EXPECT_EQ(read.m_model->shape().m_material.m_meanDilatation, choice);
        EXPECT_EQ(read.m_model->shape().m_patches.count(), choice == MeanDilatation::off ? 0 : 8);
        EXPECT_EQ(coordinatesAfterFalling(read), coordinatesAfterFalling(baked));
    }
}

TEST(Baking, KeepsHowTheMaterialBends)
{
    const TemporaryFolder folder;
    for (const Bending bending : {Bending::automatic, Bending::plain, Bending::accurate})
    {
        BakeSettings settings;
        settings.m_material.m_poissonRatio = 0.45;
        settings.m_material.m_bending = bending;
        const BakedBody baked = bakeBody(makeBox({1, 1, 1}, {2, 2, 2}), settings);
        writeBakedBody(folder.path("body.bfem"), baked);
        const BakedBody read = readBakedBody(folder.path("body.bfem"));
        EXPECT_EQ(read.m_model->shape().m_material.m_bending, bending);
        EXPECT_EQ(read.m_model->shape().m_material.m_meanDilatation, MeanDilatation::automatic);
        EXPECT_EQ(read.m_model->shape().m_assumedStrain.empty(), bending == Bending::plain);
        EXPECT_EQ(coordinatesAfterFalling(read), coordinatesAfterFalling(baked));
    }
}

TEST(Baking, KeepsHowTheMaterialYields)
{
    const TemporaryFolder folder;
    for (const Material& material : {Material::lead(), Material::mildFoam(), Material::rubber()})
    {
        BakeSettings settings;
        settings.m_material = material;
        writeBakedBody(folder.path("body.bfem"), bakeBody(makeBox({1, 1, 1}, {2, 2, 2}), settings));
        const Material read = readBakedBody(folder.path("body.bfem")).m_model->shape().m_material;
        EXPECT_EQ(read.m_yieldStress, material.m_yieldStress);
        EXPECT_EQ(read.m_hardeningModulus, material.m_hardeningModulus);
        EXPECT_EQ(read.m_plasticCreep, material.m_plasticCreep);
        EXPECT_EQ(read.m_mostPlasticStrain, material.m_mostPlasticStrain);
        EXPECT_EQ(inspectBakedBody(folder.path("body.bfem")).m_material.m_yieldStress, material.m_yieldStress);
    }
}

TEST(Baking, RoundsToSinglePrecisionUnlessToldOtherwise)
{
    BakeSettings settings;
    settings.m_material.m_poissonRatio = 0.47;
    const TetMesh mesh = makeBox({1, 1, 1}, {3, 3, 3}, {0.1, 0, 0});
    const BakedBody single = bakeBody(mesh, settings);
    settings.m_material.m_poissonRatio = 0.499;
    EXPECT_EQ(bakeBody(mesh, settings).m_model->shape().m_material.m_poissonRatio, 0.499);
    settings.m_material.m_poissonRatio = 0.47;
    settings.m_singlePrecision = false;
    const BakedBody twice = bakeBody(mesh, settings);
    EXPECT_EQ(single.m_model->shape().m_material.m_poissonRatio, static_cast<double>(0.47f));
    EXPECT_EQ(twice.m_model->shape().m_material.m_poissonRatio, 0.47);
    EXPECT_EQ(single.m_positions[1].x, static_cast<double>(static_cast<float>(mesh.restPositions()[1].x)));
    EXPECT_EQ(twice.m_positions[1].x, mesh.restPositions()[1].x);
    EXPECT_EQ(single.m_model->factorInput().m_step, static_cast<double>(1.f / 60));
}

TEST(Baking, UsesWaterDensityIfNoneIsGiven)
{
    BakeSettings settings;
    settings.m_material.m_density = 0;
    const BakedBody body = bakeBody(makeBox({1, 1, 1}, {2, 2, 2}), settings);
    double mass = 0;
    for (const double inverse : body.m_inverseMass) mass += 1 / inverse;
    EXPECT_NEAR(mass, 1000, 1e-3);  // rounded to single precision
}

TEST(Baking, MakesNoFactorIfAllNodesArePinned)
{
    BakeSettings settings;
    const TetMesh mesh = makeBox({1, 1, 1}, {1, 1, 1});
    for (int i = 0; i < mesh.nodeCount(); ++i) settings.m_pins.push_back(i);
    const std::string bytes = bytesOf(bakeBody(mesh, settings));
    const BakedBody body = readBakedBody(rawBytes(bytes), bytes.size(), "pinned");
    EXPECT_EQ(body.m_model->factorReport().m_bytes, 0u);
    EXPECT_EQ(body.m_model->factor().freeNodeCount(), 0);
}

TEST(Baking, RejectsInvalidSettings)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {1, 1, 1});
    BakeSettings settings;
    settings.m_pins = {8};
    expectRejected([&] { bakeBody(mesh, settings); }, {"pinned node 8", "[0, 8)"});
    settings.m_pins = {};
    settings.m_step = 2;
    expectRejected([&] { bakeBody(mesh, settings); }, {"time step 2", "[1e-6, 1]"});
    settings.m_step = 0.01;
    settings.m_material.m_poissonRatio = 0.5;
    expectRejected([&] { bakeBody(mesh, settings); }, {"Poisson", "0.5"});
    settings.m_material = {};
    expectRejected([&] { bakeBody(TetMesh(), settings); }, {"empty"});
    expectRejected([&] { bakeBody(Cage(), SurfaceMesh{{{0, 0, 0}}, {}}, settings); }, {"0 vertices", "1"});
    const TetMesh far = makeBox({1e-3, 1e-3, 1e-3}, {1, 1, 1}, {1e6, 0, 0});
    expectRejected([&] { bakeBody(far, settings); }, {"element 0"});
    std::string why;
    EXPECT_FALSE(bakeBody(TetMesh(), settings, &why).m_model);
    EXPECT_NE(why, "");
    EXPECT_FALSE(bakeBody(Cage(), SurfaceMesh{{{0, 0, 0}}, {}}, settings, &why).m_model);
    EXPECT_NE(why.find("0 vertices"), std::string::npos) << why;
    EXPECT_TRUE(bakeBody(mesh, settings, &why).m_model);
}

TEST(BakedFactor, PreconditionsAnotherMaterialAndIsStale)
{
    const BakedBody baked = bakeCase({{6, 3, 3}, FactorChoice::full, false});
    Material stiffer = baked.m_model->shape().m_material;
    stiffer.m_youngModulus *= 2;
    const auto shape = std::make_shared<const RestShape>(baked.m_model->mesh(), stiffer);
    const auto stale = BodyModel::withFactor(shape, baked.m_model->sharedFactor());
    EXPECT_NEAR(stale->materialMismatch(), std::sqrt(2), 1e-12);
    EXPECT_EQ(baked.m_model->materialMismatch(), 1);

    Body a(stale), b(BodyModel::create(shape, baked.m_model->factorInput()));
    StepSettings settings;
    settings.m_tolerance = 1e-8;
    SolveReport withStale, withOwn;
    for (Body* body : {&a, &b})
        for (Vec3& force : body->m_loads.m_force) force = {0, 0, -5};
    for (int k = 0; k < 10; ++k)
    {
        withStale = step(a, settings);
        withOwn = step(b, settings);
        EXPECT_EQ(withStale.m_stop, SolveStop::converged);
    }
    EXPECT_GT(withStale.m_iterations, withOwn.m_iterations);
    for (std::size_t i = 0; i < a.m_state.m_x.size(); ++i)
        EXPECT_LT(norm(a.m_state.m_x[i] - b.m_state.m_x[i]), 1e-7);  // ten steps of a relative 1e-8 of metres a second
}

TEST(BakedFactor, IsForItsNodesAlone)
{
    const BakedBody baked = bakeCase();
    const auto other = std::make_shared<const RestShape>(makeBox({1, 1, 1}, {3, 3, 3}), Material());
    expectRejected([&] { BodyModel::withFactor(other, baked.m_model->sharedFactor()); }, {"12 nodes", "64"});
    expectRejected([&] { BodyModel::withFactor(nullptr, baked.m_model->sharedFactor()); }, {"null"});
}

}  // namespace
}  // namespace bullet_fem
