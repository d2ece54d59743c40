// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bending::automatic: accurate in thin bodies, else plain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "bullet_fem/fem/body/body_snapshot.h"
#include "bullet_fem/fem/mesh/elastomer.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

Material bendingBy(Bending bending, double nu = .3)
{
    Material material = elasticMaterial(1e6, nu);
    material.m_bending = bending;
    return material;
}

TetMesh barOf(int cellsAcross)
{
    return makeBox({3, 1, 1}, {3 * cellsAcross, cellsAcross, cellsAcross});
}

// True if every element of the region has assumed strains.
bool isAccurate(const RestShape& shape, std::size_t region = 0)
{
    return shape.chosenMaterials().m_regions[region].m_material.m_bending == Bending::accurate;
}

std::vector<Vec3> positionsAfterSag(const TetMesh& mesh, const Material& material)
{
    Body body = makeBody(mesh, material, [](const Vec3& X) { return X.x == 0; });
    setGravity(body, {0, 0, -9.81});
    for (int k = 0; k < 10; ++k) step(body, StepSettings());
    return body.m_state.m_x;
}

TEST(BendingChoice, IsAccurateBelowFourCells)
{
    for (const double nu : {.3, .45})
        for (const int n : {1, 2, 3, 4, 5})
        {
            SCOPED_TRACE(n);
            const RestShape chosen(barOf(n), bendingBy(Bending::automatic, nu));
            const RestShape expected(barOf(n), bendingBy(n < 4 ? Bending::accurate : Bending::plain, nu));
            EXPECT_EQ(chosen.m_assumedStrain.m_filter, expected.m_assumedStrain.m_filter);
            EXPECT_EQ(chosen.m_patches.m_patch, expected.m_patches.m_patch);
            EXPECT_EQ(isAccurate(chosen), n < 4);
            EXPECT_EQ(chosen.m_assumedStrain.empty(), n >= 4);
        }
}

TEST(BendingChoice, HasTheBitsOfTheChosenElement)
{
    for (const int n : {2, 4})
    {
        const std::vector<Vec3> chosen = positionsAfterSag(barOf(n), bendingBy(Bending::automatic));
        const std::vector<Vec3> plain = positionsAfterSag(barOf(n), bendingBy(Bending::plain));
        const std::vector<Vec3> accurate = positionsAfterSag(barOf(n), bendingBy(Bending::accurate));
        EXPECT_EQ(largestDistance(chosen, n < 4 ? accurate : plain), 0) << n;
        EXPECT_GT(largestDistance(plain, accurate), 1e-4) << n;
    }
}

TEST(BendingChoice, HoldsForEveryLawButNotWithoutMeanDilatation)
{
    Material material = bendingBy(Bending::automatic);
    material.m_meanDilatation = MeanDilatation::off;
    EXPECT_FALSE(isAccurate(RestShape(barOf(2), material)));
    for (const Material& preset : {Material::jelly(), Material::flesh(), Material::clay(), shoreA(40)})
        EXPECT_TRUE(isAccurate(RestShape(barOf(2), withProgramDefaults(preset))));
    for (const ElasticLaw law : {ElasticLaw::ogden, ElasticLaw::damage})
    {
        material = bendingBy(Bending::automatic);
        material.m_law = law;
        material.m_lawConstants = {};
        if (law == ElasticLaw::damage) material.m_lawConstants = {1e4, 1};
        if (law == ElasticLaw::ogden) material.m_lawConstants = {6.18e5, 1.3};
        EXPECT_TRUE(isAccurate(RestShape(barOf(2), material))) << static_cast<int>(law);
    }
    material = bendingBy(Bending::automatic);
    material.m_law = ElasticLaw::orthotropic;
    EXPECT_TRUE(isAccurate(RestShape(barOf(2), material)));
    material = Material::clay();
    material.m_bending = Bending::automatic;
    material.m_relaxation[0] = {.3, 1};
    EXPECT_TRUE(isAccurate(RestShape(barOf(2), material)));
}

// Every region chooses for itself.
TEST(BendingChoice, HoldsForRegions)
{
    const TetMesh mesh = barOf(2);
    std::vector<int> label;
    for (int e = 0; e < mesh.tetCount(); ++e) label.push_back(e < mesh.tetCount() / 2 ? 0 : 1);
    const auto shapeOf = [&](const Material& other) {
        return RestShape(mesh, ElementMaterials::ofLabels(label, {{0, bendingBy(Bending::automatic)}, {1, other}}));
    };
    const RestShape plain = shapeOf(bendingBy(Bending::plain));
    EXPECT_TRUE(isAccurate(plain, 0));
    EXPECT_FALSE(isAccurate(plain, 1));
    Material own = bendingBy(Bending::automatic);
    own.m_meanDilatation = MeanDilatation::off;
    EXPECT_TRUE(isAccurate(shapeOf(own), 0));
    EXPECT_FALSE(isAccurate(shapeOf(own), 1));
    EXPECT_TRUE(isAccurate(shapeOf(Material::jelly()), 0));
    EXPECT_FALSE(isAccurate(shapeOf(Material::jelly()), 1));
}

// The material stays as given, so that bodies share models; the factor of the chosen element serves as its own.
TEST(BendingChoice, KeepsTheMaterialAsGiven)
{
    const auto automatic = std::make_shared<const RestShape>(barOf(2), bendingBy(Bending::automatic));
    const auto accurate = std::make_shared<const RestShape>(barOf(2), bendingBy(Bending::accurate));
    EXPECT_EQ(automatic->m_material, bendingBy(Bending::automatic));
    EXPECT_NE(markOf(automatic->m_materials), markOf(accurate->m_materials));
    FactorInput input;
    input.m_mass = accurate->m_lumpedMass;
    input.m_fixed.assign(input.m_mass.size(), 0);
    const auto model = BodyModel::create(accurate, input);
    EXPECT_EQ(BodyModel::withFactor(automatic, model->sharedFactor())->materialMismatch(), 1);
    const auto plain = std::make_shared<const RestShape>(barOf(2), bendingBy(Bending::plain));
    EXPECT_GT(BodyModel::withFactor(plain, model->sharedFactor())->materialMismatch(), 1);
}

TEST(BendingChoice, RefusesOtherNumbers)
{
    for (const int number : {-1, 3})
    {
        std::string why;
        EXPECT_FALSE(bendingBy(static_cast<Bending>(number)).valid(&why));
        EXPECT_EQ(why,
                  "bending is " + std::to_string(number) + ", outside [0, 2]; choose automatic, plain or accurate");
    }
}

}  // namespace
}  // namespace bullet_fem
