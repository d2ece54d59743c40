// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Stress in bars against the strength of materials: F / A in tension, M z / I in bending.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "bullet_fem/fem/step/stress.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

constexpr double kBarLength = 8, kBarYoung = 1e9;  // [m], [Pa]; the section is 1 m x 1 m, z from -1/2 to 1/2

bool barEnd(const Vec3& X)
{
    return X.x == 0;
}

// A barEnd bar in static equilibrium with small forces, n cells through its thickness.
struct Bar
{
    explicit Bar(int n)
        : m_body(makeBody(makeBox({kBarLength, 1, 1}, {int(kBarLength) * n, n, n}, {0, -0.5, -0.5}),
                          elasticMaterial(kBarYoung, 0.3), barEnd))
    {
    }

    const TetMesh& mesh() const { return m_body.m_model->mesh(); }

    void load(const std::vector<Vec3>& force)
    {
        const std::vector<Vec3> u = LinearSystem(m_body.m_model->shape(), barEnd).displacement(force);
        for (std::size_t i = 0; i < u.size(); ++i) m_body.m_state.m_x[i] = mesh().restPositions()[i] + u[i];
        elementStresses(m_body, m_element);
        nodeStresses(*m_body.m_model, m_element, m_node);
    }

    Vec3 centre(int e) const
    {
        Vec3 sum;
        for (int node : mesh().tets()[e]) sum += mesh().restPositions()[node];
        return 0.25 * sum;
    }

    Body m_body;
    std::vector<Stress> m_element, m_node;
};

// Away from the ends each element has it (Saint-Venant).
TEST(StressInBars, TensionIsForceOverArea)
{
    Bar bar(2);
    const double force = 1000;  // [N] on 1 m2: a strain of 1e-6
    std::vector<Vec3> load(bar.mesh().nodeCount());
    const std::vector<double> area = faceAreas(bar.mesh(), [](const Vec3& X) { return X.x == kBarLength; });
    for (std::size_t i = 0; i < load.size(); ++i) load[i].x = force * area[i];
    bar.load(load);
    int looked = 0;
    for (std::size_t e = 0; e < bar.m_element.size(); ++e)
    {
        const bool inTheMiddle = std::fabs(bar.centre(int(e)).x - kBarLength / 2) < 2;
        looked += inTheMiddle;
        EXPECT_LT(inTheMiddle * std::fabs(vonMises(bar.m_element[e]) / force - 1), 0.01) << e;
        EXPECT_LT(inTheMiddle * std::fabs(bar.m_element[e].xx / force - 1), 0.01) << e;
    }
    EXPECT_GT(looked, 100);
}

// Measured accuracy of linear tetrahedra.
struct Cells
{
    int m_thickness;   // cells through the thickness
    double m_slice;    // fitted sigma_xx over M z / I
    double m_hottest;  // largest nodal value over M / (I / (1/2)) at the clamp
};

void PrintTo(const Cells& cells, std::ostream* out)
{
    *out << cells.m_thickness << " cells";
}

class BendingStress : public testing::TestWithParam<Cells>
{
protected:
    // Under its own weight q = rho g A: M(x) = q (L - x)^2 / 2, I = 1 / 12.
    BendingStress() : m_bar(GetParam().m_thickness)
    {
        std::vector<Vec3> weight(m_bar.mesh().nodeCount());
        for (std::size_t i = 0; i < weight.size(); ++i)
            weight[i].z = -kLoad * m_bar.m_body.m_model->shape().m_lumpedMass[i] / 1000;
        m_bar.load(weight);
    }
    static double moment(double x) { return kLoad * (kBarLength - x) * (kBarLength - x) / 2; }

    static constexpr double kLoad = 1;  // q [N/m], which bends the bar by 1e-6 of its length
    Bar m_bar;
};

// sigma_xx = M z / I, fitted over the elements of a slice: sum sigma z over sum M z^2 / I.
TEST_P(BendingStress, SliceFollowsTheMomentLine)
{
    for (const double slice : {1.5, 3.0})
    {
        double found = 0, expected = 0;
        for (std::size_t e = 0; e < m_bar.m_element.size(); ++e)
        {
            const Vec3 c = m_bar.centre(static_cast<int>(e));
            const bool inside = std::fabs(c.x - slice) < 0.5;
            found += inside * m_bar.m_element[e].xx * c.z;
            expected += inside * moment(c.x) * 12 * c.z * c.z;
        }
        EXPECT_NEAR(found / expected, GetParam().m_slice, 0.01) << "x = " << slice;
    }
}

// Within the first half metre of eight: at the clamp itself, which prevents contraction, von Mises is slightly lower.
TEST_P(BendingStress, IsLargestAtTheEdgesOfTheClamp)
{
    const auto less = [](const Stress& a, const Stress& b) { return vonMises(a) < vonMises(b); };
    const auto node = std::max_element(m_bar.m_node.begin(), m_bar.m_node.end(), less);
    const auto element = std::max_element(m_bar.m_element.begin(), m_bar.m_element.end(), less);
    const Vec3 X = m_bar.mesh().restPositions()[node - m_bar.m_node.begin()];
    const Vec3 c = m_bar.centre(static_cast<int>(element - m_bar.m_element.begin()));
    EXPECT_LE(X.x, 0.5);
    EXPECT_LE(c.x, 0.5);
    EXPECT_EQ(std::fabs(X.z), 0.5);
    EXPECT_GT(std::fabs(c.z), 0.25);
    EXPECT_NEAR(vonMises(*node) / (6 * moment(0)), GetParam().m_hottest, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Thickness, BendingStress,
                         testing::Values(Cells{2, .811, .558}, Cells{4, .935, .791}, Cells{8, .982, .918}),
                         [](const auto& suite) { return "Cells" + std::to_string(suite.param.m_thickness); });

}  // namespace
}  // namespace bullet_fem
