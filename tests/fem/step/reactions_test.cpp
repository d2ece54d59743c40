// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Reactions of fixed nodes: each is the energy's derivative at rest, and their sum balances momentum.
#include "bullet_fem/fem/step/reactions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/stepping_scenes.h"

namespace bullet_fem
{
namespace
{

Vec3 sumOf(const std::vector<NodeReaction>& all)
{
    Vec3 sum;
    for (const NodeReaction& reaction : all) sum += reaction.m_force;
    return sum;
}

// In an undamped step of implicit Euler each fixed node at rest balances the elastic force and the load at the step's
// end, for any motion of the other nodes; `others` are further forces on the nodes [N].
void expectEnergyDerivatives(Body& body, const std::vector<Vec3>& others, double tolerance)
{
    const std::vector<NodeReaction>* found = reactions(body);
    ASSERT_TRUE(found);
    constexpr double kMove = 1e-5;  // [m]
    for (const NodeReaction& reaction : *found)
    {
        EXPECT_TRUE(body.m_state.m_fixed[reaction.m_node]);
        const Vec3 load = body.m_loads.m_force[reaction.m_node] + others[reaction.m_node];
        for (int c = 0; c < 3; ++c)
        {
            double& x = body.m_state.m_x[reaction.m_node][c];
            const double start = x;
            x = start + kMove;
            const double above = mechanicalEnergy(body);
            x = start - kMove;
            const double below = mechanicalEnergy(body);
            x = start;
            EXPECT_NEAR((above - below) / (2 * kMove) - load[c], reaction.m_force[c], tolerance)
                << reaction.m_node << ", " << c;
        }
    }
}

Body undampedBeam(Material material)
{
    material.m_massDamping = material.m_stiffnessDamping = 0;
    return makeBody(makeBox({1, 0.4, 0.4}, {5, 2, 2}), material, [](const Vec3& X) { return X.x == 0; });
}

TEST(Reactions, AreTheEnergysDerivativeAtRest)
{
    Body beam = clampedBeam();
    const std::size_t nodes = beam.m_state.m_x.size();
    for (Vec3& force : beam.m_loads.m_force) force = {0, 0, -0.2};
    StepSettings settings;
    settings.m_tolerance = 1e-9;
    beam.m_loads.m_massDamping = 8;
    for (int k = 0; k < 900; ++k) step(beam, settings);
    expectEnergyDerivatives(beam, std::vector<Vec3>(nodes), 2e-3);
    EXPECT_EQ(9u, reactions(beam)->size());
    EXPECT_NEAR(0.2 * double(nodes), sumOf(*reactions(beam)).z, 1e-8);
}

// Quasi-Newton iterations follow the linear solve in this step, and leave up to a twentieth of its right-hand side.
TEST(Reactions, AreTheEnergysDerivativeInAViolentStep)
{
    Material material = elasticMaterial(2e4, 0.3);
    material.m_law = ElasticLaw::neoHooke;
    Body beam = undampedBeam(material);
    setGravity(beam, {60, 0, 0});
    StepSettings settings;
    settings.m_tolerance = 1e-9;
    for (int k = 0; k < 8; ++k) step(beam, settings);
    double largest = 0;
    for (const NodeReaction& reaction : *reactions(beam)) largest = std::max(largest, norm(reaction.m_force));
    expectEnergyDerivatives(beam, std::vector<Vec3>(beam.m_state.m_x.size()), 0.01 * largest);
}

TEST(Reactions, IncludeTheTensionOfACable)
{
    Body beam = undampedBeam(elasticMaterial(1e6, 0.3));
    const TetMesh& mesh = beam.m_model->mesh();
    const int held = nodeAt(mesh, {0, 0.2, 0.2}), pulled = nodeAt(mesh, {1, 0.2, 0.2});
    Cable cable;
    cable.m_points.resize(2);
    cable.m_points[0].m_nodes[0] = held;
    cable.m_points[1].m_nodes[0] = pulled;
    cable.m_stiffness = 1e6;
    cable.m_restLength = 1;
    beam.m_actuators.m_cables.push_back(cable);
    beam.m_loads.m_force[pulled] = {500, 0, 0};
    StepSettings settings;
    settings.m_tolerance = 1e-9;
    step(beam, settings);
    const Vec3 along = beam.m_state.m_x[pulled] - beam.m_state.m_x[held];
    const double tension = cable.tensionAt(norm(along));
    EXPECT_GT(tension, 100);
    std::vector<Vec3> pull(mesh.nodeCount());
    pull[held] = (tension / norm(along)) * along;
    beam.m_actuators = {};  // before the reactions are read
    expectEnergyDerivatives(beam, pull, 0.01 * tension);
}

// Three nodes on a line along y, the middle one displaced: with a lever above 1e-3 of the radius of gyration they bear
// a moment about the line.
TEST(Reactions, BearAMomentForNodesBesideALine)
{
    const auto isHeld = [](const Vec3& X) { return X.x == 0 && X.z == 0.2; };
    const auto momentLeft = [&](double beside)
    {
        Body beam = makeBody(makeBox({1, 0.4, 0.4}, {5, 2, 2}), elasticMaterial(1e5, 0.3), isHeld);
        setGravity(beam, {0, 0, -9.81});
        beam.m_state.m_x[nodeAt(beam.m_model->mesh(), {0, 0.2, 0.2})].z += beside;
        for (int k = 0; k < 4; ++k) step(beam, {});
        const BodyState before = beam.m_state;
        const StepSettings settings;
        step(beam, settings);
        Vec3 moment = (1 / settings.m_step) * (angularMomentum(beam.m_state) - angularMomentum(before));
        for (std::size_t i = 0; i < before.m_x.size(); ++i)
            moment += -cross(0.5 * (before.m_x[i] + beam.m_state.m_x[i]), beam.m_loads.m_force[i]);
        for (const NodeReaction& reaction : *reactions(beam)) moment += -cross(reaction.m_point, reaction.m_force);
        return std::fabs(moment.y);
    };
    EXPECT_GT(momentLeft(1.2e-3), 0.1);
    EXPECT_LT(momentLeft(2e-3), 1e-9);
}

struct HeldStep
{
    double m_damping, m_tolerance;  // of the step
};

void PrintTo(const HeldStep& how, std::ostream* out)
{
    *out << how.m_damping << ", " << how.m_tolerance;
}

class HeldMotion : public testing::TestWithParam<HeldStep>
{
};

// Fixed nodes with random motion, and impulses as of contact, also on fixed nodes.
TEST_P(HeldMotion, BalancesMomentumInEveryStep)
{
    Body beam = clampedBeam();
    StepSettings settings;
    settings.m_numericalDamping = GetParam().m_damping;
    settings.m_tolerance = GetParam().m_tolerance;
    for (unsigned seed = 1; seed <= 8; ++seed)
    {
        disturb(beam, seed);
        for (std::size_t i = 0; i < beam.m_state.m_x.size(); ++i)
            if (beam.m_state.m_fixed[i]) beam.m_loads.m_targetVelocity[i] = 0.1 * beam.m_loads.m_force[i];
        const BodyState before = beam.m_state;
        step(beam, settings);
        Vec3 force = (1 / settings.m_step) * (linearMomentum(beam.m_state) - linearMomentum(before));
        Vec3 moment = (1 / settings.m_step) * (angularMomentum(beam.m_state) - angularMomentum(before));
        double scale = 0;
        const double alpha = beam.m_model->shape().m_material.m_massDamping;
        const auto subtract = [&](const Vec3& point, const Vec3& f)
        {
            force += -f;
            moment += -cross(point, f);
            scale += norm(f);
        };
        const auto middle = [&](std::size_t i) { return 0.5 * (before.m_x[i] + beam.m_state.m_x[i]); };
        for (std::size_t i = 0; i < before.m_x.size(); ++i)
            subtract(middle(i), beam.m_loads.m_force[i] - alpha * before.m_mass[i] * beam.m_state.m_v[i]);
        const std::vector<NodeReaction>* all = reactions(beam);
        ASSERT_TRUE(all);
        for (const NodeReaction& reaction : *all)
        {
            EXPECT_EQ(0, norm(reaction.m_point - middle(reaction.m_node)));
            subtract(reaction.m_point, reaction.m_force);
        }
        const double error = settings.m_numericalDamping < 1 ? 1e-3 : 1e-12;  // damping by mass acts on v*
        EXPECT_LT(norm(force), error * scale);
        EXPECT_LT(norm(moment), error * scale);
    }
}

INSTANTIATE_TEST_SUITE_P(Steps, HeldMotion,
                         testing::Values(HeldStep{1, 1e-3}, HeldStep{1, 1e-8}, HeldStep{0, 1e-3}, HeldStep{0.3, 1e-8}));

TEST(Reactions, AreUnknownUntilAStepComputesThem)
{
    Body beam = clampedBeam();
    EXPECT_FALSE(reactions(beam));
    const StepSettings settings;
    solveFreeMotion(beam, settings);
    EXPECT_FALSE(reactions(beam)) << "within a step";
    finishStep(beam, settings);
    ASSERT_TRUE(reactions(beam));
    EXPECT_EQ(reactions(beam), reactions(beam));
    solveFreeMotion(beam, settings);
    abandonStep(beam);
    EXPECT_FALSE(reactions(beam));
    step(beam, settings);
    EXPECT_TRUE(reactions(beam));
    beam.setModel(clampedBeam().m_model);
    EXPECT_FALSE(reactions(beam)) << "with another factor";
    Body block = freeBlock();
    step(block, settings);
    EXPECT_FALSE(reactions(block)) << "of a free body";
}

}  // namespace
}  // namespace bullet_fem
