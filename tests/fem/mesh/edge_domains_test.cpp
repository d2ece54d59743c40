// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/edge_domains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "bullet_fem/fem/mesh/rest_shape.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/lattice_box.h"

namespace bullet_fem
{
namespace
{

Material bending(double young = 1e6)
{
    Material material = elasticMaterial(young, .3);
    material.m_accurateBending = true;
    return material;
}

constexpr std::pair<int, int> kEdgesOfTet[] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

std::pair<int, int> edgeOf(const TetMesh& mesh, int e, int k)
{
    const Tet& tet = mesh.tets()[e];
    return std::minmax({tet[kEdgesOfTet[k].first], tet[kEdgesOfTet[k].second]});
}

TEST(EdgeDomains, AreTheElementsAroundEveryEdge)
{
    const TetMesh mesh = shuffledMesh(makeBox({1, 1, 1}, {3, 3, 3}, {}, CellSplit::kuhnSix), .1, 1);
    const RestShape shape(mesh, bending());
    const EdgeDomains& domains = shape.m_edgeDomains;
    std::set<std::pair<int, int>> edges;
    for (int e = 0; e < mesh.tetCount(); ++e)
        for (int k = 0; k < 6; ++k)
        {
            edges.insert(edgeOf(mesh, e, k));
            const int d = domains.m_domain[e][k];
            const auto begin = domains.m_element.begin() + domains.m_start[d],
                       end = domains.m_element.begin() + domains.m_start[d + 1];
            EXPECT_EQ(std::count(begin, end, e), 1);
            for (auto other = begin; other != end; ++other)
                EXPECT_TRUE(
                    edgeOf(mesh, *other, 0) == edgeOf(mesh, e, k) || edgeOf(mesh, *other, 1) == edgeOf(mesh, e, k) ||
                    edgeOf(mesh, *other, 2) == edgeOf(mesh, e, k) || edgeOf(mesh, *other, 3) == edgeOf(mesh, e, k) ||
                    edgeOf(mesh, *other, 4) == edgeOf(mesh, e, k) || edgeOf(mesh, *other, 5) == edgeOf(mesh, e, k));
        }
    EXPECT_EQ(domains.count(), static_cast<int>(edges.size()));
    EXPECT_EQ(domains.m_element.size(), 6 * mesh.tets().size());
}

// Weights are volumes, times the filled fraction, times the smoothed share of each element.
TEST(EdgeDomains, WeighByVolume)
{
    const TetMesh mesh = shuffledMesh(makeBox({1, 1, 1}, {2, 2, 2}), .1, 1);
    std::vector<double> filled(mesh.tets().size());
    for (std::size_t e = 0; e < filled.size(); ++e) filled[e] = .2 + .8 * static_cast<double>(e % 5) / 5;
    const RestShape shape(mesh, bending(), filled);
    const EdgeDomains& domains = shape.m_edgeDomains;
    for (int d = 0; d < domains.count(); ++d)
    {
        double sum = 0;
        const int first = domains.m_start[d];
        const auto smoothed = [&](int k)
        { return domains.m_share[domains.m_element[k]] * shape.m_elements[domains.m_element[k]].m_volume; };
        for (int k = first; k < domains.m_start[d + 1]; ++k)
        {
            sum += domains.m_weight[k];
            EXPECT_NEAR(domains.m_weight[k] * smoothed(first), domains.m_weight[first] * smoothed(k), 1e-15);
        }
        EXPECT_NEAR(sum, 1, 1e-14);
    }
}

TEST(EdgeDomains, DoNotCrossRegions)
{
    const TetMesh mesh = makeBox({4, 2, 2}, {4, 2, 2});
    std::vector<int> label;
    for (const Tet& tet : mesh.tets())
    {
        Vec3 middle;
        for (const int node : tet) middle += .25 * mesh.restPositions()[node];
        label.push_back(static_cast<int>(middle.x));
    }
    Material plain = elasticMaterial(1e6, .3);
    // Elements 0 and 3 are of one material, 1 of another, 2 of one without accurate bending.
    const ElementMaterials materials =
        ElementMaterials::ofLabels(label, {{0, bending()}, {1, bending(3e6)}, {2, plain}, {3, bending()}});
    const RestShape shape(mesh, materials);
    const EdgeDomains& domains = shape.m_edgeDomains;
    for (int d = 0; d < domains.count(); ++d)
        for (int k = domains.m_start[d]; k < domains.m_start[d + 1]; ++k)
        {
            EXPECT_EQ(label[domains.m_element[k]], label[domains.m_element[domains.m_start[d]]]);
            EXPECT_NE(label[domains.m_element[k]], 2);
        }
    for (int e = 0; e < mesh.tetCount(); ++e) EXPECT_EQ(domains.m_share[e] == 0, label[e] == 2) << e;
}

TEST(EdgeDomains, AreEmptyForOtherMaterials)
{
    EXPECT_TRUE(RestShape(makeBox({1, 1, 1}, {2, 2, 2}), elasticMaterial(1e6, .45)).m_edgeDomains.empty());
}

TEST(EdgeDomains, NeedMeanDilatation)
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
