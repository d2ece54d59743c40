// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/element_materials.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/fem/mesh/rest_shape.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/expect_rejected.h"

namespace bullet_fem
{
namespace
{

const std::map<int, Material> kTable = {
    {4, elasticMaterial(1e5, .3, 900)}, {7, elasticMaterial(3e6, .48, 2000)}, {9, elasticMaterial(2e7, .1, 500)}};

// Assigns the elements to two regions by the height of their centroids.
std::vector<int> layers(const TetMesh& mesh, double height, int low, int high)
{
    std::vector<int> labels;
    for (const Tet& tet : mesh.tets())
    {
        double z = 0;
        for (const int node : tet) z += 0.25 * mesh.restPositions()[node].z;
        labels.push_back(z < height ? low : high);
    }
    return labels;
}

TEST(MeshElementMaterials, LabelsChooseFromTheTable)
{
    const ElementMaterials materials = ElementMaterials::ofLabels({7, 4, 7, 7}, kTable);
    EXPECT_FALSE(materials.isUniform());
    ASSERT_EQ(materials.m_regions.size(), 2u);  // label 9 has no elements
    EXPECT_EQ(materials.m_regions[0].m_label, 4);
    EXPECT_EQ(materials.m_regions[1].m_label, 7);
    EXPECT_EQ(materials.of(0), kTable.at(7));
    EXPECT_EQ(materials.of(1), kTable.at(4));
    EXPECT_EQ(materials.of(3), kTable.at(7));
    EXPECT_NO_THROW(materials.validate(4));
    EXPECT_TRUE(ElementMaterials::ofLabels({4, 4}, kTable).isUniform());
}

TEST(MeshElementMaterials, EqualMaterialsOfElementsMakeARegion)
{
    const Material &soft = kTable.at(4), &stiff = kTable.at(9);
    const ElementMaterials materials = ElementMaterials::ofElements({soft, stiff, stiff, soft});
    ASSERT_EQ(materials.m_regions.size(), 2u);
    EXPECT_EQ(materials.m_regions[1].m_label, 1);  // that of its first element
    EXPECT_EQ(materials.m_regionOf, (std::vector<int>{0, 1, 1, 0}));
    EXPECT_EQ(ElementMaterials::ofElements({soft, soft}), ElementMaterials(soft));
}

TEST(MeshElementMaterials, RejectsInconsistentInput)
{
    expectRejected(
        [] {
            ElementMaterials::ofLabels({4, 5, 4, 5}, kTable);
        },
        {"region 5", "element 1 and 1 more", "4, 7, 9", "give one for 5"});
    expectRejected([] { ElementMaterials::ofLabels({4}, {}); }, {"region 4", "regions: none"});
    expectRejected([] { ElementMaterials::ofLabels({}, kTable); }, {"no region labels"});
    expectRejected([] { ElementMaterials::ofElements({}); }, {"no materials"});
    const TetMesh mesh = makeBox({1, 1, 1}, {1, 1, 1});
    expectRejected(
        [&] {
            RestShape(mesh, ElementMaterials::ofLabels({4, 7, 7}, kTable));
        },
        {"3 elements", "the mesh has 5"});
    const auto shape = [&](const Material& other) {
        RestShape(mesh, ElementMaterials::ofLabels({4, 4, 2, 4, 4}, {{4, kTable.at(4)}, {2, other}}));
    };
    Material bad = kTable.at(4);
    bad.m_youngModulus = -1;
    expectRejected([&] { shape(bad); }, {"region 2", "Young's modulus", "-1", "(0, 1e+13]"});
    bad = kTable.at(4);
    bad.m_density = 0;
    expectRejected([&] { shape(bad); }, {"density of region 4", "900", "region 2", "or none"});
    bad = kTable.at(4);
    bad.m_stiffnessDamping = .01;
    expectRejected([&] { shape(bad); }, {"stiffness damping", "region 4", "0.01", "give all its regions the same"});
    bad = kTable.at(4);
    bad.m_massDamping = 2;
    expectRejected([&] { shape(bad); }, {"mass damping", "region 4", "2"});
    expectRejected(
        [&] {
            RestShape(mesh, ElementMaterials({{0, kTable.at(4)}}, {0, 0, 1, 0, 0}));
        },
        {"element 2", "[0, 1)"});
    expectRejected(
        [&] {
            RestShape(mesh, ElementMaterials({{0, kTable.at(4)}, {1, kTable.at(7)}}, {}));
        },
        {"2 regions"});
}

TEST(MeshElementMaterials, EveryElementHasItsModuliAndMass)
{
    const TetMesh mesh = makeBox({1, 1, 2}, {3, 3, 6});
    const std::vector<int> labels = layers(mesh, .7, 4, 7);
    const RestShape shape(mesh, ElementMaterials::ofLabels(labels, kTable), {}, 1.5);
    Vec3 moment;
    double mass = 0;
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        const Material& material = kTable.at(labels[e]);
        EXPECT_EQ(shape.materialOf(e), material);
        EXPECT_DOUBLE_EQ(shape.m_elements[e].m_muVolume, material.lameMu() * mesh.tetVolume(e));
        EXPECT_DOUBLE_EQ(shape.m_elements[e].m_lambdaVolume, material.lameLambda() * mesh.tetVolume(e));
    }
    for (int i = 0; i < mesh.nodeCount(); ++i)
    {
        mass += shape.m_lumpedMass[i];
        moment += shape.m_lumpedMass[i] * mesh.restPositions()[i];
    }
    // 2/3 m of 900 and 4/3 m of 2000 kg/m3; a cube's tetrahedra give its nodes no moment of their own.
    const double low = 1.5 * 900 * 2. / 3, high = 1.5 * 2000 * 4. / 3;
    EXPECT_NEAR(mass, low + high, 1e-12 * mass);
    EXPECT_NEAR(moment.z / mass, (low / 3 + high * 4. / 3) / (low + high), 1e-12);
    EXPECT_NEAR(moment.x / mass, .5, 1e-12);
    double lumped = 0;
    for (const double m : lumpedMasses(mesh, {}, shape.m_materials, 1.5)) lumped += m;
    EXPECT_NEAR(lumped, mass, 1e-12 * mass);
}

// Regions of equal materials give a uniform body, bitwise equal.
TEST(MeshElementMaterials, EqualRegionsAreAUniformBody)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {3, 3, 3});
    const Material& material = kTable.at(7);
    const RestShape one(mesh, material),
        two(mesh, ElementMaterials::ofLabels(layers(mesh, .5, 1, 2), {{1, material}, {2, material}}));
    EXPECT_EQ(one.m_patches.m_element, two.m_patches.m_element);
    EXPECT_EQ(one.m_patches.m_start, two.m_patches.m_start);
    EXPECT_EQ(one.m_lumpedMass, two.m_lumpedMass);
    for (int e = 0; e < mesh.tetCount(); ++e)
        EXPECT_EQ(one.m_elements[e].m_lambdaVolume, two.m_elements[e].m_lambdaVolume);
}

// Beside a nearly incompressible layer another such one, or one without patches; on lattices and on another mesh.
TEST(MeshElementMaterials, PatchesStayInTheirRegion)
{
    std::map<int, Material> table = kTable;
    table[8] = elasticMaterial(1e5, .48, 900);
    for (const TetMesh& mesh :
         {makeBox({1, 1, 1}, {4, 4, 4}), makeBox({1, 1, 1}, {4, 4, 4}, {}, CellSplit::kuhnSix), makeSphere(.5, 5)})
    {
        const double middle = mesh.restPositions()[0].z < 0 ? .03 : .55;
        for (const int other : {4, 8})
        {
            const std::vector<int> labels = layers(mesh, middle, 7, other);
            const RestShape shape(mesh, ElementMaterials::ofLabels(labels, table));
            ASSERT_FALSE(shape.m_patches.empty());
            int largest = 0;
            for (int p = 0; p < shape.m_patches.count(); ++p)
            {
                std::set<int> inside;
                const int start = shape.m_patches.m_start[p];
                for (int k = 0; k < shape.m_patches.size(p); ++k)
                    inside.insert(labels[shape.m_patches.m_element[start + k]]);
                EXPECT_EQ(inside.size(), 1u) << "patch " << p;
                EXPECT_TRUE(*inside.begin() != 4 || shape.m_patches.size(p) == 1);
                largest = std::max(largest, shape.m_patches.size(p));
            }
            EXPECT_GE(largest, 4);
        }
    }
}

}  // namespace
}  // namespace bullet_fem
