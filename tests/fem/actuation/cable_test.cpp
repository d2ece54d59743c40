// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_fem/fem/body/actuators.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/expect_rejected.h"

namespace bullet_fem
{
namespace
{

const double kPi = 3.14159265358979323846;

CablePoint at(int node)
{
    CablePoint point;
    point.m_nodes = {node, node, node, node};
    return point;
}

bool atWall(const Vec3& X)
{
    return X.x == 0;
}

// One cell of 1 x .2 x .2 m, fixed at x = 0, whose other end can move along x only, apart from small errors: four
// cables between opposite nodes share the stiffness [N/m].
struct Slider
{
    explicit Slider(double stiffness, double restLength, double step = 1.0 / 60)
        : m_body(makeBody(makeBox({1, 0.2, 0.2}, {1, 1, 1}), elasticMaterial(10, 0), atWall, step))
    {
        const std::vector<Vec3>& X = m_body.m_model->mesh().restPositions();
        for (std::size_t i = 0; i < X.size(); ++i)
        {
            if (X[i].x == 0) continue;
            Cable cable;
            cable.m_points = {at(nodeAt(m_body.m_model->mesh(), {0, X[i].y, X[i].z})), at(static_cast<int>(i))};
            cable.m_stiffness = stiffness / 4;
            cable.m_restLength = restLength;
            m_body.m_actuators.m_cables.push_back(cable);
            m_body.m_state.m_mass[i] = 2.5;
        }
    }

    void settle(const StepSettings& settings)
    {
        m_body.m_loads.m_massDamping = 5;
        for (int k = 0; k < 300; ++k) step(m_body, settings);
        m_body.m_loads.m_massDamping = 0;
    }
    double x() const
    {
        double sum = 0;
        for (const Vec3& x : m_body.m_state.m_x) sum += x.x / 4;
        return sum;
    }
    void throwEnd(double v)
    {
        for (std::size_t i = 0; i < m_body.m_state.m_v.size(); ++i)
            if (!m_body.m_state.m_fixed[i]) m_body.m_state.m_v[i].x = v;
    }

    Body m_body;
    double m_mass = 10;  // [kg]
};

// A beam of .2 x .04 x .04 m along x, fixed at x = 0, with a cable along it in the middle plane, one cell below its
// upper face, through points one cell apart.
Body beamWithCable(double young, int cells, double step)
{
    Body body =
        makeBody(makeBox({0.2, 0.04, 0.04}, {5 * cells, cells, cells}), elasticMaterial(young, 0), atWall, step);
    const TetMesh& mesh = body.m_model->mesh();
    Cable cable;
    for (int k = 0; k <= 5 * cells; ++k)
        cable.m_points.push_back(at(nodeAt(mesh, {0.2 * k / (5 * cells), 0.04 - 0.04 / cells, 0.02})));
    body.m_actuators.m_cables.push_back(cable);
    return body;
}

// --- A given tension ---

TEST(CableTension, BendsABeamToAConstantCurvature)
{
    const int cells = 8;
    const double young = 1e6, T = 0.2, e = 0.02 - 0.04 / cells, I = std::pow(0.04, 4) / 12, L = 0.2;
    Body body = beamWithCable(young, cells, 0.2);
    body.m_actuators.m_cables[0].m_tension = T;
    EXPECT_LE(relax(body, 1e-9), 1e-9);
    const TetMesh& mesh = body.m_model->mesh();
    const double curvature = T * e / (young * I);
    // Along the neutral fibre: y = curvature x^2 / 2.
    for (const double x : {0.1, 0.2})
    {
        const double y = body.m_state.m_x[nodeAt(mesh, {x, 0.02, 0.02})].y - 0.02;
        EXPECT_NEAR(y, 0.5 * curvature * x * x, 0.04 * 0.5 * curvature * x * x) << x;
    }
    const double shortening = L - body.m_state.m_x[nodeAt(mesh, {L, 0.02, 0.02})].x;
    EXPECT_NEAR(shortening, T * L / (young * 0.04 * 0.04),
                0.04 * shortening);  // a face's centre, not the cable's end point
}

TEST(CableTension, HasNoSumAndNoTorque)
{
    Body body = makeBody(makeBox({0.4, 0.1, 0.1}, {8, 2, 2}), elasticMaterial(1e-3, 0));
    RandomVectors random(3);
    for (Vec3& x : body.m_state.m_x) x += 0.02 * random.next() + Vec3{1, 2, 3};
    Cable cable;
    cable.m_points = {at(0), at(20), at(33), at(70)};
    cable.m_points[1].m_nodes = {20, 24, 25, 26};
    cable.m_points[1].m_weights = {0.1, 0.2, 0.3, 0.4};
    for (const double stiffness : {0.0, 1e6})
    {
        cable.m_tension = 30;
        cable.m_stiffness = stiffness;
        body.m_actuators.m_cables = {cable};
        StepSettings settings;
        settings.m_step = 1e-6;
        settings.m_tolerance = 1e-12;
        solveFreeMotion(body, settings);
        Vec3 sum, torque;
        double size = 0;
        for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
        {
            const Vec3 p = body.m_state.m_mass[i] * velocity(body)[i];
            sum += p;
            torque += cross(body.m_state.m_x[i], p);
            size += norm(p);
        }
        EXPECT_GT(size, 1e-5);
        EXPECT_LE(norm(sum), 1e-8 * size);
        EXPECT_LE(norm(torque), 4e-8 * size);
    }
}

// The tension is a fifth of E times the section's area. Transversely it is as stiff as the elements at its points, and
// 160 times above the stability limit of an explicit step.
TEST(CableTension, IsStableHoweverStrong)
{
    for (const double damping : {1.0, 0.0})
    {
        Body body = beamWithCable(1e5, 2, 1.0 / 60);
        Cable& cable = body.m_actuators.m_cables[0];
        cable.m_tension = 32;
        RandomVectors random(4);
        for (Vec3& v : body.m_state.m_v) v = 0.5 * random.next();
        StepSettings settings;
        settings.m_numericalDamping = damping;
        double late = 0;
        for (int k = 0; k < 1200; ++k)
        {
            body.m_loads.m_massDamping = k < 600 ? 5 : 0;
            step(body, settings);
            if (k >= 600) late = std::max(late, kineticEnergy(body.m_state));
        }
        EXPECT_LE(late, 1e-6) << damping;
    }
}

// --- A cable that stretches ---

TEST(ElasticCable, StretchesByForceOverStiffness)
{
    Slider slider(5000, 1, 0.2);
    for (Vec3& f : slider.m_body.m_loads.m_force) f = {25, 0, 0};
    EXPECT_LE(relax(slider.m_body, 1e-8), 1e-8);
    const double ownStiffness = 10 * 0.04;
    EXPECT_NEAR(slider.x() - 1, 100 / (5000 + ownStiffness), 2e-8);
}

// omega = sqrt(k / m), with the cable always taut.
TEST(ElasticCable, SwingsWithItsFrequency)
{
    const double h = 1.0 / 240, k = 4000;
    Slider slider(k, 0.9, h);
    slider.throwEnd(0.2);
    for (Vec3& x : slider.m_body.m_state.m_x) x.x *= 0.92;  // close to the equilibrium under the load
    for (Vec3& f : slider.m_body.m_loads.m_force) f = {k * 0.02 / 4, 0, 0};
    StepSettings settings;
    settings.m_step = h;
    settings.m_numericalDamping = 0;
    double last = slider.x(), time = 0, first = -1, crossing = 0;
    int periods = 0;
    for (int s = 0; s < 480; ++s)
    {
        step(slider.m_body, settings);
        time += h;
        const double now = slider.x();
        if (last < 0.92 && now >= 0.92)
        {
            crossing = time - h * (now - 0.92) / (now - last);
            if (first < 0)
                first = crossing;
            else
                ++periods;
        }
        last = now;
    }
    ASSERT_GE(periods, 4);
    const double period = 2 * kPi * std::sqrt(slider.m_mass / k);
    EXPECT_NEAR((crossing - first) / periods, period, 0.01 * period);
}

// Moving towards the cable's other end: the slack cable, however stiff, does not change the motion.
TEST(ElasticCable, NeverPushes)
{
    for (const double stiffness : {1e5, 1e7, 1e12})
        for (const double damping : {1.0, 0.0})
        {
            Slider slider(stiffness, 1);
            StepSettings settings;
            settings.m_numericalDamping = damping;
            for (Vec3& f : slider.m_body.m_loads.m_force) f = {25, 0, 0};
            slider.settle(settings);
            EXPECT_NEAR(slider.x() - 1, 100 / stiffness, 1e-4);
            const double before = slider.x();
            slider.throwEnd(-1);
            slider.m_body.m_loads.m_priorVelocity.assign(slider.m_body.m_state.m_v.size(), Vec3());
            step(slider.m_body, settings);
            const double expected = -1 + 10.0 / 60;  // the load still acts, 100 N on 10 kg
            EXPECT_NEAR(slider.m_body.m_state.m_v.back().x, expected, 0.01) << stiffness << ", " << damping;
            EXPECT_LT(slider.x(), before - 0.8 / 60 * 0.5);
        }
}

// A load reverses the pull within a step: the cable is slack in that step.
TEST(ElasticCable, LetsGoInTheStepInWhichItIsSlack)
{
    Slider slider(1e6, 1);
    for (Vec3& f : slider.m_body.m_loads.m_force) f = {25, 0, 0};
    slider.settle(StepSettings());
    for (Vec3& f : slider.m_body.m_loads.m_force) f = {-250, 0, 0};
    step(slider.m_body, StepSettings());
    EXPECT_NEAR(slider.m_body.m_state.m_v.back().x, -100.0 / 60, 0.02);
}

// The wall at the cable's fixed end starts to move.
TEST(ElasticCable, FollowsItsFixedEndInTheSameStep)
{
    Slider slider(1e7, 1);
    for (Vec3& v : slider.m_body.m_loads.m_targetVelocity) v = {-1, 0, 0};
    step(slider.m_body, StepSettings());
    const double hhk = 1e7 / 3600;  // (m + h^2 k) v = h^2 k v_wall
    EXPECT_NEAR(slider.m_body.m_state.m_v.back().x, -hhk / (slider.m_mass + hhk), 1e-4);
}

TEST(ElasticCable, CatchesAMovingEnd)
{
    for (const double stiffness : {1e4, 1e8, 1e12})
    {
        Slider slider(stiffness, 1.1);
        slider.throwEnd(1);
        double farthest = 0, fastest = 0;
        for (int k = 0; k < 60; ++k)
        {
            const int iterations = step(slider.m_body, StepSettings()).m_iterations;
            EXPECT_LE(iterations, 12) << stiffness;
            farthest = std::max(farthest, slider.x());
            fastest = std::max(fastest, std::fabs(slider.m_body.m_state.m_v.back().x));
        }
        EXPECT_LE(fastest, 1.0 + 1e-3);
        EXPECT_LE(farthest, 1.1 + std::sqrt(10 / stiffness) + 1e-4) << stiffness;
        EXPECT_GE(farthest, 1.0999) << stiffness;
    }
}

// Two coincident cables equal one of twice the stiffness, for any stiffness.
TEST(ElasticCable, MayLieBesideItsLike)
{
    for (const double stiffness : {5000.0, 1e12})
    {
        Slider slider(stiffness, 1);
        std::vector<Cable>& cables = slider.m_body.m_actuators.m_cables;
        const std::vector<Cable> once = cables;
        cables.insert(cables.end(), once.begin(), once.end());
        for (Vec3& f : slider.m_body.m_loads.m_force) f = {25, 0, 0};
        slider.settle(StepSettings());
        EXPECT_NEAR(slider.x() - 1, 100 / (2 * stiffness + 0.4), 1e-6) << stiffness;
        EXPECT_LE(kineticEnergy(slider.m_body.m_state), 1e-10) << stiffness;
    }
}

// Cables along one line through points of different nodes have equal forces to single precision. Four of 1e8 N/m and
// more may explode on this beam of 0.1 MPa, as rounding decides.
TEST(ElasticCable, MayLieNearItsLike)
{
    Body body = beamWithCable(1e5, 4, 1.0 / 60);
    const std::vector<CablePoint> line = body.m_actuators.m_cables[0].m_points;
    std::vector<Cable> cables(4);
    cables[0].m_points = line;
    cables[1].m_points.assign(line.rbegin(), line.rend());
    cables[2].m_points = {line.front(), line[7], line.back()};
    cables[3].m_points = {line.front(), line.back()};
    for (Cable& cable : cables)
    {
        cable.m_stiffness = 1e6;
        cable.m_restLength = 0.19;
    }
    body.m_actuators.m_cables = cables;
    for (int k = 0; k < 240; ++k)
    {
        const SolveReport report = step(body, StepSettings());
        EXPECT_EQ(report.m_stop, SolveStop::converged) << k;
        EXPECT_LE(report.m_iterations, 80) << k;
    }
    EXPECT_NEAR(cables[0].length(body.m_state.m_x), 0.19, 1e-5);
    EXPECT_LE(kineticEnergy(body.m_state), 1e-5);
}

// --- Errors ---

TEST(CableErrors, NameValueRangeAndRemedy)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {1, 1, 1});
    Cable good;
    good.m_points = {at(0), at(7)};
    good.validate(mesh);
    const auto expect = [&](const Cable& cable, const char* part)
    { expectRejected([&] { cable.validate(mesh); }, {part}); };
    Cable c = good;
    c.m_points.pop_back();
    expect(c, "has 1 points; give at least 2");
    c = good;
    c.m_points[1] = at(8);
    expect(c, "node 8 of the cable is not in [0, 8)");
    c.m_points[1] = at(-1);
    expect(c, "node -1 of the cable is not in [0, 8)");
    c = good;
    for (const double weight : {0.9, std::nan("")})
    {
        c.m_points[0].m_weights[0] = weight;
        expect(c, "barycentric weights");
    }
    c = good;
    for (const double weight : {0.9998, 1.0002})
    {
        c.m_points[0].m_weights[0] = weight;
        expect(c, "barycentric weights");
    }
    c.m_points[0].m_weights[0] = 0.99991;
    c.m_tension = 1e9;
    c.m_stiffness = 1e12;
    c.m_restLength = 1e6;
    c.validate(mesh);
    c.m_tension = 1.01e9;
    expect(c, "the cable's tension is 1010000000, not in [0, 1000000000] N; a cable pulls only");
    c.m_tension = 0;
    c.m_stiffness = 1.01e12;
    expect(c, "the cable's stiffness is");
    c.m_stiffness = 1;
    c.m_restLength = 1.01e6;
    expect(c, "the cable's rest length is");
    for (const double bad : {-1.0, std::nan(""), HUGE_VAL})
    {
        c = good;
        c.m_tension = bad;
        expect(c, "the cable's tension is");
        c = good;
        c.m_stiffness = bad;
        expect(c, "the cable's stiffness is");
        c = good;
        c.m_restLength = bad;
        expect(c, "the cable's rest length is");
    }
}

}  // namespace
}  // namespace bullet_fem
