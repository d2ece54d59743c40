// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/factor/body_model.h"

#include <gmock/gmock.h>

#include <cmath>

#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/expect_rejected.h"
#include "fem/scenes/test_constants.h"

namespace bullet_fem
{
namespace
{

class BodyModelInput : public testing::Test
{
protected:
    std::shared_ptr<const RestShape> m_shape =
        std::make_shared<const RestShape>(makeBox({1, 1, 1}, {2, 2, 2}), Material());
    FactorInput m_input{m_shape->m_lumpedMass, std::vector<unsigned char>(27, 0), 1.0 / 60};

    auto create() const
    {
        return [this] { BodyModel::create(m_shape, m_input); };
    }
};

TEST_F(BodyModelInput, IsKept)
{
    m_input.m_fixed[3] = 1;
    const auto model = BodyModel::create(m_shape, m_input);
    EXPECT_EQ(model->factorInput(), m_input);
    EXPECT_EQ(&model->shape(), m_shape.get());
    EXPECT_EQ(model->sharedShape(), m_shape);
    EXPECT_EQ(&model->mesh(), &m_shape->m_mesh);
    EXPECT_EQ(model->nodeCount(), 27);
}

TEST_F(BodyModelInput, IsComparedByAllOfIt)
{
    FactorInput other = m_input;
    EXPECT_EQ(other, m_input);
    other.m_step = 0.01;
    EXPECT_FALSE(other == m_input);
    other = m_input;
    other.m_mass[26] *= 2;
    EXPECT_FALSE(other == m_input);
    other = m_input;
    other.m_fixed[0] = 1;
    EXPECT_FALSE(other == m_input);
}

TEST_F(BodyModelInput, IsReportedOn)
{
    const FactorReport report = BodyModel::create(m_shape, m_input)->factorReport();
    EXPECT_THAT(report.m_backend, testing::AnyOf(testing::StartsWith("AMD "), testing::StartsWith("Eigen ")));
    EXPECT_THAT(report.m_ordering, testing::AnyOf("METIS", "AMD", "Eigen"));
    EXPECT_GE(report.m_entries, 81);           // the diagonal
    EXPECT_LE(report.m_entries, 81 * 82 / 2);  // the full triangle
    EXPECT_GE(report.m_supernodes, 1);
    EXPECT_LE(report.m_supernodes, 27);
    EXPECT_TRUE(std::isfinite(report.m_seconds) && report.m_seconds >= 0) << report.m_seconds;
}

TEST_F(BodyModelInput, NeedsNoFactorWithoutAFreeNode)
{
    m_input.m_fixed.assign(27, 1);
    const auto model = BodyModel::create(m_shape, m_input);
    EXPECT_EQ(model->factorReport().m_entries, 0);
    EXPECT_EQ(model->factorReport().m_supernodes, 0);
}

TEST_F(BodyModelInput, IsRejectedWithoutAShape)
{
    m_shape = nullptr;
    expectRejected(create(), {"rest shape is null"});
}

TEST_F(BodyModelInput, IsRejectedWithAnInvalidStep)
{
    m_input.m_step = 0;
    expectRejected(create(), {"time step 0", "[1e-6, 1]", "fixed step"});
    m_input.m_step = -0.25;
    expectRejected(create(), {"time step -0.25", "[1e-6, 1]"});
    m_input.m_step = 1.5;
    expectRejected(create(), {"time step 1.5", "[1e-6, 1]"});
    m_input.m_step = 9e-7;
    expectRejected(create(), {"time step 9e-07", "[1e-6, 1]"});
    m_input.m_step = kNaN;
    expectRejected(create(), {"time step nan", "[1e-6, 1]"});
    m_input.m_step = kInf;
    expectRejected(create(), {"time step inf", "[1e-6, 1]"});
}

TEST_F(BodyModelInput, IsAcceptedAtTheEndsOfTheStepRange)
{
    m_input.m_step = 1e-6;
    EXPECT_NO_THROW(create()());
    m_input.m_step = 1;
    EXPECT_NO_THROW(create()());
}

TEST_F(BodyModelInput, IsRejectedWithArraysOfTheWrongSize)
{
    m_input.m_mass.pop_back();
    expectRejected(create(), {"26 masses", "27 fixed flags", "27 nodes"});
    m_input.m_mass.resize(27, 1);
    m_input.m_fixed.push_back(0);
    expectRejected(create(), {"27 masses", "28 fixed flags", "27 nodes"});
}

TEST_F(BodyModelInput, IsRejectedWithInvalidMasses)
{
    m_input.m_mass[7] = 0;
    expectRejected(create(), {"node 7 is 0 kg", "(0, inf)"});
    m_input.m_mass[7] = -1e-8;
    expectRejected(create(), {"node 7 is -1e-08 kg", "(0, inf)"});
    m_input.m_mass[7] = kNaN;
    expectRejected(create(), {"node 7 is nan kg", "(0, inf)"});
    m_input.m_mass[7] = kInf;
    expectRejected(create(), {"node 7 is inf kg", "(0, inf)"});
}

// Light and heavy, soft and stiff bodies: scaling keeps the factor within single precision.
TEST_F(BodyModelInput, ExtremeValuesGiveAFiniteStep)
{
    struct Extreme
    {
        double m_mass, m_young;
    };
    for (const Extreme& extreme : {Extreme{1e-12, 1e-6}, {1e-12, 1}, {1e12, 1e-6}, {1e12, 1e13}, {1, 1e13}})
    {
        const auto shape = std::make_shared<const RestShape>(m_shape->m_mesh, elasticMaterial(extreme.m_young, 0.49));
        m_input.m_mass.assign(27, extreme.m_mass);
        Body body(BodyModel::create(shape, m_input));
        body.m_state.m_v[13] = {1, 2, 3};
        step(body, StepSettings());
        EXPECT_LE(largestDistance(body.m_state.m_x, m_shape->m_mesh.restPositions()), 1) << extreme.m_mass;
    }
}

// The limit is compared with the factor's exact size in bytes before it is computed.
TEST(BodyModelLimit, AFactorBeyondTheLimitIsRefusedWithItsSize)
{
    const std::shared_ptr<const BodyModel> model = makeBody(makeBox({1, 1, 1}, {3, 3, 3}), Material()).m_model;
    FactorInput input = model->factorInput();
    input.m_maxBytes = model->factorReport().m_bytes;
    EXPECT_EQ(BodyModel::create(model->sharedShape(), input)->factorReport().m_bytes, input.m_maxBytes);
    const std::string size = std::to_string(input.m_maxBytes);
    --input.m_maxBytes;
    try
    {
        BodyModel::create(model->sharedShape(), input);
        ADD_FAILURE() << "no exception";
    }
    catch (const std::runtime_error& error)
    {
        EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr(size), testing::HasSubstr("coarser")));
    }
}

TEST(BodyState, StartsAtRest)
{
    const Body body = makeBody(makeBox({1, 1, 1}, {1, 1, 1}), Material(), [](const Vec3& X) { return X.x == 0; });
    const BodyState& s = body.m_state;
    EXPECT_EQ(largestDistance(s.m_x, body.m_model->mesh().restPositions()), 0);
    EXPECT_EQ(largestDistance(s.m_v, std::vector<Vec3>(8)), 0);
    EXPECT_EQ(s.m_mass, body.m_model->factorInput().m_mass);
    EXPECT_EQ(s.m_fixed, body.m_model->factorInput().m_fixed);
    EXPECT_GE(s.m_elementRotation.size(), 5u);  // plus padding of the last block of kernel lanes
    for (const Quaternion& q : s.m_elementRotation) EXPECT_EQ(squaredNorm(toMatrix(q) - Mat3::identity()), 0);
}

TEST(Body, ExchangesItsFactorAndKeepsItsMotion)
{
    Body body = makeBody(makeBox({1, 1, 1}, {2, 2, 2}), Material());
    body.m_state.m_v[5] = {1, 2, 3};
    step(body, StepSettings());
    const BodyState before = body.m_state;
    FactorInput input = body.m_model->factorInput();
    input.m_step = 0.01;
    input.m_fixed[0] = 1;
    body.setModel(BodyModel::create(body.m_model->sharedShape(), input));
    EXPECT_EQ(body.m_model->factorInput().m_step, 0.01);
    EXPECT_EQ(largestDistance(body.m_state.m_x, before.m_x), 0);
    EXPECT_EQ(largestDistance(body.m_state.m_v, before.m_v), 0);
    EXPECT_EQ(body.m_state.m_fixed, before.m_fixed);  // the state's own flags
    StepSettings settings;
    settings.m_step = 0.01;
    EXPECT_EQ(step(body, settings).m_stop, SolveStop::converged);
}

TEST(Body, RejectsAModelOfAnotherMesh)
{
    Body body = makeBody(makeBox({1, 1, 1}, {1, 1, 1}), Material());
    const Body larger = makeBody(makeBox({1, 1, 1}, {2, 1, 1}), Material());
    const Body otherwise = makeBody(makeBox({1, 1, 1}, {1, 1, 1}, {}, CellSplit::kuhnSix), Material());
    expectRejected([&] { body.setModel(larger.m_model); }, {"another mesh"});
    expectRejected([&] { body.setModel(otherwise.m_model); }, {"another mesh"});
    expectRejected([&] { body.setModel(nullptr); }, {"another mesh"});
    EXPECT_EQ(body.m_model->nodeCount(), 8);
    EXPECT_EQ(step(body, StepSettings()).m_stop, SolveStop::converged);
}

}  // namespace
}  // namespace bullet_fem
