// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Baked bodies whose elements are in regions of several materials.
#include <gmock/gmock.h>

#include <cstddef>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/baked_files.h"
#include "fem/scenes/expect_rejected.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

constexpr int kMaxInts = 120;  // elements below

// 2 x 2 x 6 cells, the lower half of region 7 and the upper of region -2.
BakeSettings layeredSettings(const TetMesh& mesh)
{
    BakeSettings settings;
    for (const Tet& tet : mesh.tets())
    {
        double z = 0;
        for (const int node : tet) z += 0.25 * mesh.restPositions()[node].z;
        settings.m_labels.push_back(z < 1.5 ? 7 : -2);
    }
    Material soft, stiff;
    soft.m_youngModulus = 2e5;
    soft.m_poissonRatio = .47;
    soft.m_stiffnessDamping = stiff.m_stiffnessDamping = 0.01;
    stiff.m_youngModulus = 3.3e7;
    stiff.m_density = 2500.1;
    stiff.m_yieldStress = 4096;
    stiff.m_hardeningModulus = 1e5;
    settings.m_regionMaterials = {{7, soft}, {-2, stiff}};
    settings.m_pins = {0, 1, 2};
    return settings;
}

std::vector<double> fallen(const BakedBody& baked)
{
    Body body(baked.m_model);
    for (int i = 0; i < baked.m_model->nodeCount(); ++i)
        body.m_loads.m_force[i] = {1, 0, -9.81 * body.m_state.m_mass[i]};
    for (int k = 0; k < 30; ++k) step(body, StepSettings());
    std::vector<double> coordinates;
    for (const Vec3& x : body.m_state.m_x) coordinates.insert(coordinates.end(), {x.x, x.y, x.z});
    return coordinates;
}

class BakedRegions : public testing::Test
{
protected:
    const TetMesh m_mesh = makeBox({1, 1, 3}, {2, 2, 6});
    const BakedBody m_baked = bakeBody(m_mesh, layeredSettings(m_mesh));
    const std::string m_bytes = bytesOf(m_baked);
};

TEST_F(BakedRegions, ComeBackWithLabelsTableAndBits)
{
    const BakedBody read = readBakedBody(rawBytes(m_bytes), m_bytes.size(), "memory");
    const ElementMaterials& materials = read.m_model->shape().m_materials;
    EXPECT_EQ(materials, m_baked.m_model->shape().m_materials);
    ASSERT_EQ(materials.m_regions.size(), 2u);
    EXPECT_EQ(materials.m_regions[0].m_label, -2);
    EXPECT_EQ(materials.m_regions[1].m_label, 7);
    EXPECT_EQ(materials.m_regions[1].m_material.m_poissonRatio, static_cast<double>(.47f));  // rounded as by Bullet
    EXPECT_EQ(materials.m_regions[0].m_material.m_density, static_cast<double>(2500.1f));
    EXPECT_EQ(materials.m_regions[0].m_material.m_yieldStress, 4096);
    EXPECT_FALSE(materials.m_regions[1].m_material.yields());
    EXPECT_EQ(read.m_model->materialMismatch(), 1);
    EXPECT_EQ(fallen(read), fallen(m_baked));
    EXPECT_EQ(bytesOf(read), m_bytes);
    double mass = 0;
    for (const double inverse : read.m_inverseMass) mass += 1 / inverse;
    EXPECT_NEAR(mass, 1.5 * 1000 + 1.5 * 2500.1, 1e-6 * mass);
}

// Files of one material keep their old version and bytes, so that older readers accept them.
TEST_F(BakedRegions, AloneHaveTheNewVersion)
{
    const TemporaryFolder folder;
    writeBakedBody(folder.path("body.bfem"), m_baked);
    const BakedFileInfo info = inspectBakedBody(folder.path("body.bfem"));
    EXPECT_EQ(info.m_version, 3);
    EXPECT_EQ(info.m_regions, 2);
    BakeSettings settings = layeredSettings(m_mesh);
    settings.m_regionMaterials[7] = settings.m_regionMaterials[-2];
    settings.m_labels.assign(settings.m_labels.size(), 7);
    writeBakedBody(folder.path("body.bfem"), bakeBody(m_mesh, settings));
    EXPECT_EQ(inspectBakedBody(folder.path("body.bfem")).m_version, 2);
    EXPECT_EQ(inspectBakedBody(folder.path("body.bfem")).m_regions, 1);
}

TEST_F(BakedRegions, RejectInvalidSettings)
{
    BakeSettings settings = layeredSettings(m_mesh);
    settings.m_labels.pop_back();
    expectRejected([&] { bakeBody(m_mesh, settings); }, {"119 elements", "120"});
    settings = layeredSettings(m_mesh);
    settings.m_regionMaterials.erase(7);
    expectRejected([&] { bakeBody(m_mesh, settings); }, {"region 7", "materials for the regions: -2"});
}

// The checksums are right.
TEST_F(BakedRegions, RejectInvalidRegionNumbers)
{
    const auto with = [&](std::size_t fromEnd, std::int32_t entry)
    {
        std::string bytes = m_bytes;
        std::memcpy(&bytes[bytes.size() - fromEnd], &entry, sizeof entry);
        return complaint(sealed(bytes));
    };
    const std::size_t indices = alignedBytes(sizeof(std::int32_t) * kMaxInts),
                      table = indices + 2 * sizeof(BakedRegion);
    EXPECT_EQ(complaint(m_bytes), "");
    EXPECT_THAT(with(indices, 2), HasSubstr("element 0 is in region 2"));
    EXPECT_THAT(with(indices, -1), HasSubstr("element 0 is in region -1"));
    EXPECT_THAT(with(table - 4, 65), HasSubstr("mean dilatation is 65"));
    EXPECT_THAT(with(table - 4, 16), HasSubstr("region 0 has no constants of its law"));
    EXPECT_THAT(with(table - 48, -1), AllOf(HasSubstr("region -2"), HasSubstr("yield stress")));
    EXPECT_THAT(with(table - 12, -1), AllOf(HasSubstr("region -2"), HasSubstr("Young's modulus")));
    const auto headed = [&](std::uint32_t regions, std::uint32_t version)
    {
        std::string bytes = m_bytes;
        BakedHeader header = {};
        std::memcpy(&header, bytes.data(), sizeof header);
        header.m_regions = regions;
        std::memcpy(&bytes[0], &header, sizeof header);
        bytes = sealed(bytes);
        EXPECT_EQ(version, regions > 0 ? 3u : 2u);
        return complaint(bytes);
    };
    EXPECT_THAT(headed(0, 2), HasSubstr("sections take"));
    EXPECT_THAT(headed(121, 3), HasSubstr("121 regions of 120 elements"));
    EXPECT_THAT(headed(40, 3), HasSubstr("sections take"));
}

// A factor of other materials: its mismatch is that of the worst element.
TEST_F(BakedRegions, TellHowStaleAFactorIs)
{
    ElementMaterials stiffer = m_baked.m_model->shape().m_materials;
    stiffer.m_regions[1].m_material.m_youngModulus *= 9;
    const auto shape = std::make_shared<const RestShape>(m_baked.m_model->mesh(), stiffer);
    EXPECT_NEAR(BodyModel::withFactor(shape, m_baked.m_model->sharedFactor())->materialMismatch(), 3, 1e-12);
    const auto uniform = std::make_shared<const RestShape>(m_baked.m_model->mesh(), stiffer.first());
    EXPECT_GT(BodyModel::withFactor(uniform, m_baked.m_model->sharedFactor())->materialMismatch(), 10);
    FactorOfModel other = m_baked.m_model->sharedFactor();
    other.m_materials.m_regionOf.pop_back();
    expectRejected([&] { BodyModel::withFactor(uniform, other); }, {"119 elements", "120"});
    BakedBody spoilt = m_baked;
    spoilt.m_model = BodyModel::withFactor(shape, m_baked.m_model->sharedFactor());
    std::string why;
    writeBakedBody(TemporaryFolder().path("body.bfem"), spoilt, &why);
    EXPECT_THAT(why, HasSubstr("another material"));
}

}  // namespace
}  // namespace bullet_fem
