// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/assumed_strain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bullet_fem/fem/mesh/rest_shape.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/lattice_box.h"

namespace bullet_fem
{
namespace
{

Material bending(double young = 1e6)
{
    Material material = elasticMaterial(young, .3);
    material.m_bending = Bending::accurate;
    return material;
}

void expectNear(const SymmetricTensor& a, const SymmetricTensor& b)
{
    EXPECT_NEAR(contraction(a + -1.0 * b, a + -1.0 * b), 0, 1e-24);
}

constexpr SymmetricTensor kStrain = {.1, -.2, .4, .3, -.5, .7};

// Cubes of six elements with inner nodes, and cells four times as long along x and y as along z without.
TEST(AssumedStrain, ScalesShearByTheRatioOfExtents)
{
    const RestShape cubes(makeBox({3, 3, 3}, {3, 3, 3}, {}, CellSplit::kuhnSix), bending());
    const RestShape flat(makeBox({8, 8, 1}, {2, 2, 1}, {}, CellSplit::kuhnSix), bending());
    const double inner = std::sqrt(AssumedStrain::kShare), thin = std::sqrt(AssumedStrain::kThinShare * 1.3);
    for (int p = 0; p < cubes.m_patches.count(); ++p)
        expectNear(cubes.m_assumedStrain.filtered(p, kStrain), inner * deviator(kStrain));
    SymmetricTensor scaled = deviator(kStrain);
    scaled.xz /= 4, scaled.yz /= 4;
    for (int p = 0; p < flat.m_patches.count(); ++p)
        expectNear(flat.m_assumedStrain.filtered(p, kStrain), thin * scaled);
}

TEST(AssumedStrain, IsSymmetricAndItsSquareActsTwice)
{
    const RestShape shape(shuffledMesh(makeBox({3, 2, 1}, {3, 3, 3}), .15, 1), bending());
    const AssumedStrain& assumed = shape.m_assumedStrain;
    const SymmetricTensor other = {.3, .2, -.6, -.1, .4, .2};
    for (int p = 0; p < shape.m_patches.count(); ++p)
    {
        EXPECT_NEAR(contraction(other, assumed.filtered(p, kStrain)), contraction(assumed.filtered(p, other), kStrain),
                    1e-14);
        AssumedStrain square;
        square.m_filter.push_back(assumed.square(p));
        expectNear(square.filtered(0, kStrain), assumed.filtered(p, assumed.filtered(p, kStrain)));
        EXPECT_NEAR(trace(assumed.filtered(p, kStrain)), 0, 1e-14);
    }
}

// Means over a patch stay, and strains that are equal in all elements.
TEST(AssumedStrain, KeepsMeans)
{
    const RestShape shape(shuffledMesh(makeBox({3, 2, 1}, {3, 3, 3}), .15, 1), bending());
    for (int p = 0; p < shape.m_patches.count(); ++p)
    {
        const int count = shape.m_patches.size(p);
        double share[ElementPatches::kMax] = {};
        SymmetricTensor strain[ElementPatches::kMax], equal[ElementPatches::kMax], before, after;
        for (int k = 0; k < count; ++k)
        {
            share[k] = shape.shareOfPatch(shape.m_patches.m_element[shape.m_patches.m_start[p] + k]);
            strain[k] = (k + 1.0) * kStrain;
            equal[k] = kStrain;
            before += share[k] * strain[k];
        }
        shape.m_assumedStrain.assume(p, count, share, strain);
        shape.m_assumedStrain.assume(p, count, share, equal);
        for (int k = 0; k < count; ++k) after += share[k] * strain[k];
        expectNear(after, before);
        for (int k = 0; k < count; ++k) expectNear(equal[k], kStrain);
    }
}

TEST(AssumedStrain, DoesNotCrossRegions)
{
    const TetMesh mesh = makeBox({3, 2, 2}, {3, 2, 2});
    std::vector<int> label;
    for (const Tet& tet : mesh.tets())
    {
        Vec3 middle;
        for (const int node : tet) middle += .25 * mesh.restPositions()[node];
        label.push_back(static_cast<int>(middle.x));
    }
    Material plain = elasticMaterial(1e6, .3);
    plain.m_meanDilatation = MeanDilatation::on;
    const RestShape shape(mesh, ElementMaterials::ofLabels(label, {{0, bending()}, {1, bending(3e6)}, {2, plain}}));
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        const int p = shape.m_patches.m_patch[e];
        EXPECT_EQ(label[e], label[shape.m_patches.m_element[shape.m_patches.m_start[p]]]);
        if (label[e] == 2) expectNear(shape.m_assumedStrain.filtered(p, kStrain), deviator(kStrain));
    }
}

TEST(AssumedStrain, IsEmptyForOtherMaterials)
{
    EXPECT_TRUE(RestShape(makeBox({1, 1, 1}, {2, 2, 2}), elasticMaterial(1e6, .45)).m_assumedStrain.empty());
}

TEST(AssumedStrain, NeedsMeanDilatation)
{
    std::string why;
    Material material = bending();
    EXPECT_TRUE(material.valid(&why));
    EXPECT_TRUE(material.usesMeanDilatation());
    material.m_meanDilatation = MeanDilatation::off;
    EXPECT_FALSE(material.valid(&why));
    EXPECT_EQ(why, "accurate bending does not go with mean dilatation off; take automatic or on");
    material = bending();
    material.m_yieldStress = 1e4;
    material.m_relaxation[0] = {.3, 1};
    EXPECT_TRUE(material.valid(&why)) << why;
}

}  // namespace
}  // namespace bullet_fem
