// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Baked orthotropic bodies: one region, or several of which some are orthotropic.
#include <gmock/gmock.h>

#include <cstddef>

#include "bullet_fem/fem/laws/law_table.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/baked_files.h"
#include "fem/scenes/expect_rejected.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

Material bakedFibres()
{
    Material material;
    material.m_law = ElasticLaw::orthotropic;
    material.m_orthotropic = Orthotropic::transverselyIsotropic(3.3e6, 1.1e5, .31, .4, 7e4);
    material.m_orthotropic.m_along = {1, .1, 0};
    material.m_stiffnessDamping = 0.01;
    return material;
}

BakeSettings fibrousSettings(const TetMesh& mesh, bool regions)
{
    BakeSettings settings;
    settings.m_material = bakedFibres();
    settings.m_pins = {0, 1, 2};
    if (!regions) return settings;
    Material soft, turned = bakedFibres();
    soft.m_stiffnessDamping = 0.01;
    turned.m_orthotropic.m_along = {0, 0, 1};
    for (int e = 0; e < mesh.tetCount(); ++e) settings.m_labels.push_back(3 * (e % 3));
    settings.m_regionMaterials = {{0, soft}, {3, turned}, {6, bakedFibres()}};
    return settings;
}

std::vector<Vec3> swung(const BakedBody& baked)
{
    Body body(baked.m_model);
    for (int i = 0; i < baked.m_model->nodeCount(); ++i)
        body.m_loads.m_force[i] = {1, 0, -9.81 * body.m_state.m_mass[i]};
    for (int k = 0; k < 30; ++k) step(body, StepSettings());
    return body.m_state.m_x;
}

class BakedOrthotropic : public testing::TestWithParam<bool>  // true: several regions
{
protected:
    const TetMesh m_mesh = makeBox({1, 1, 3}, {2, 2, 6});
    const BakedBody m_baked = bakeBody(m_mesh, fibrousSettings(m_mesh, GetParam()));
    const std::string m_bytes = bytesOf(m_baked);
};

TEST_P(BakedOrthotropic, ComeBackWithConstantsAndBits)
{
    const BakedBody read = readBakedBody(rawBytes(m_bytes), m_bytes.size(), "memory");
    const ElementMaterials& materials = read.m_model->shape().m_materials;
    EXPECT_EQ(materials, m_baked.m_model->shape().m_materials);
    EXPECT_EQ(materials.m_regions.size(), GetParam() ? 3u : 1u);
    const Orthotropic& last = materials.m_regions.back().m_material.m_orthotropic;
    EXPECT_EQ(last.m_young[0], 3.3e6);
    EXPECT_EQ(last.m_poisson[0], static_cast<double>(.31f));  // rounded as by Bullet
    EXPECT_EQ(last.m_along.y, static_cast<double>(.1f));
    EXPECT_EQ(read.m_model->materialMismatch(), 1);
    const std::vector<Vec3> found = swung(read), expected = swung(m_baked);
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(norm(found[i] - expected[i]), 0) << i;
    EXPECT_EQ(bytesOf(read), m_bytes);
}

TEST_P(BakedOrthotropic, HaveAVersionOfTheirOwnAndTellTheirConstants)
{
    const TemporaryFolder folder;
    writeBakedBody(folder.path("body.bfem"), m_baked);
    const BakedFileInfo info = inspectBakedBody(folder.path("body.bfem"));
    EXPECT_EQ(info.m_version, 4);
    EXPECT_EQ(info.m_regions, GetParam() ? 3 : 1);
    EXPECT_EQ(info.m_material, m_baked.m_model->shape().m_material);
    EXPECT_EQ(info.m_material.isOrthotropic(), !GetParam());  // of the first region
}

// With right checksums: the constants of the last region are the end of the file, before its padding.
TEST_P(BakedOrthotropic, InvalidConstantsAreRejected)
{
    const std::size_t count = GetParam() ? 3 : 1;
    const std::size_t last =
        m_bytes.size() - alignedBytes(count * sizeof(BakedConstants)) + (count - 1) * sizeof(BakedConstants);
    const auto with = [&](std::size_t number, double value)
    {
        std::string bytes = m_bytes;
        std::memcpy(&bytes[last + number * sizeof(double)], &value, sizeof value);
        return complaint(sealed(bytes));
    };
    EXPECT_EQ(complaint(m_bytes), "");
    EXPECT_THAT(with(0, -1), HasSubstr("E1 [Pa] is -1"));
    EXPECT_THAT(with(3, 99), HasSubstr("nu12 [-] is 99"));
    EXPECT_THAT(with(8, 0), HasSubstr("G23 [Pa] is 0"));
    EXPECT_THAT(with(9, std::nan("")), HasSubstr("axis 1"));
}

// Every law with accurate bending, alone and beside a region of Hooke's law.
TEST_P(BakedOrthotropic, ComeBackWithAccurateBendingOfEveryLaw)
{
    for (const ElasticLaw law : {ElasticLaw::neoHooke, ElasticLaw::ogden, ElasticLaw::damage, ElasticLaw::orthotropic})
    {
        BakeSettings settings;
        Material& bent = settings.m_material = law == ElasticLaw::orthotropic ? bakedFibres() : Material();
        bent.m_law = law;
        for (std::size_t k = 0; k < constantsOf(law).size(); ++k)
            bent.m_lawConstants[k] = constantsOf(law)[k].m_default;
        bent.m_bending = Bending::accurate;
        Material hooke;
        hooke.m_stiffnessDamping = bent.m_stiffnessDamping;
        settings.m_pins = {0, 1, 2};
        for (int e = 0; e < m_mesh.tetCount() && GetParam(); ++e) settings.m_labels.push_back(e % 2);
        if (GetParam()) settings.m_regionMaterials = {{0, hooke}, {1, bent}};
        const BakedBody baked = bakeBody(m_mesh, settings);
        const std::string bytes = bytesOf(baked);
        const BakedBody read = readBakedBody(rawBytes(bytes), bytes.size(), "memory");
        EXPECT_EQ(read.m_model->shape().m_materials, baked.m_model->shape().m_materials);
        EXPECT_EQ(read.m_model->shape().m_materials.m_regions.back().m_material.m_bending, Bending::accurate);
        EXPECT_EQ(read.m_model->materialMismatch(), 1);
        const std::vector<Vec3> found = swung(read), expected = swung(baked);
        for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(norm(found[i] - expected[i]), 0) << i;
        EXPECT_EQ(bytesOf(read), bytes);
    }
}

INSTANTIATE_TEST_SUITE_P(Regions, BakedOrthotropic, testing::Bool(),
                         [](const auto& suite) { return std::string(suite.param ? "Several" : "One"); });

// Laws with constants of their own use the same section.
TEST(BakedLaws, KeepTheirConstants)
{
    const TetMesh mesh = makeBox({1, 1, 2}, {1, 1, 2});
    for (const ElasticLaw law : {ElasticLaw::ogden, ElasticLaw::damage})
        for (const bool regions : {false, true})
        {
            BakeSettings settings;
            settings.m_material.m_law = law;
            for (std::size_t k = 0; k < constantsOf(law).size(); ++k)
                settings.m_material.m_lawConstants[k] = constantsOf(law)[k].m_default;
            for (int e = 0; e < mesh.tetCount() && regions; ++e) settings.m_labels.push_back(e % 2);
            settings.m_regionMaterials = {{0, settings.m_material}, {1, Material()}};
            const BakedBody baked = bakeBody(mesh, settings);
            const std::string bytes = bytesOf(baked);
            const BakedBody read =
                readBakedBody(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), "law.bfem");
            EXPECT_EQ(read.m_model->shape().m_materials, baked.m_model->shape().m_materials);
            EXPECT_EQ(read.m_model->shape().materialOf(0).m_law, law);
        }
}

}  // namespace
}  // namespace bullet_fem
