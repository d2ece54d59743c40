// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Vibrations against implicit Euler's discrete law. Each step divides an oscillator's x + i v / omega by 1 + i omega h:
// the frequency becomes atan(omega h) / h, and the amplitude shrinks by (1 + omega^2 h^2)^-1/2.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

struct Vibration
{
    const char* m_name;
    bool m_axial;        // else the lowest bending mode
    double m_phaseStep;  // omega h [-]
};

void PrintTo(const Vibration& vibration, std::ostream* out)
{
    *out << vibration.m_name;
}

class ElasticityVibration : public testing::TestWithParam<Vibration>
{
};

bool rodEnd(const Vec3& X)
{
    return X.x == 0;
}

const TetMesh& bar()
{
    static const TetMesh mesh = makeBox({10, 1, 1}, {20, 2, 2});
    return mesh;
}

// The eigenmode of the discrete K and M, so that the mesh does not affect the comparison.
Mode chosenMode(const RestShape& shape, bool axial)
{
    const std::vector<Mode> modes = LinearSystem(shape, rodEnd).lowestModes(8);
    const auto along = [&shape](const Mode& m) { return std::fabs(weightedMean(shape.m_lumpedMass, m.m_shape).x); };
    const auto maxAlong = [&along](const Mode& a, const Mode& b) { return along(a) < along(b); };
    return axial ? *std::max_element(modes.begin(), modes.end(), maxAlong) : modes.front();
}

// The modal coordinate phi^T M u.
double modalPart(const Mode& mode, const std::vector<double>& mass, const std::vector<Vec3>& u)
{
    double sum = 0;
    for (std::size_t i = 0; i < u.size(); ++i) sum += mass[i] * dot(mode.m_shape[i], u[i]);
    return sum;
}

TEST_P(ElasticityVibration, FollowsImplicitEulersLaw)
{
    const Vibration& p = GetParam();
    const Mode mode = chosenMode(RestShape(bar(), elasticMaterial(1e6, .3)), p.m_axial);
    StepSettings settings;
    settings.m_step = p.m_phaseStep / mode.m_omega;
    settings.m_tolerance = 1e-9;
    Body body = makeBody(bar(), elasticMaterial(1e6, .3), rodEnd, settings.m_step);
    BodyState& s = body.m_state;
    const std::vector<Vec3> X = s.m_x;
    const double amplitude = 1e-4;  // tip 1e-6 of the length: rotations are negligible
    for (std::size_t i = 0; i < X.size(); ++i) s.m_x[i] += amplitude * mode.m_shape[i];

    const int n = 60;
    std::complex<double> previous(amplitude, 0);
    double phase = 0;
    for (int k = 0; k < n; ++k)
    {
        step(body, settings);
        std::vector<Vec3> u = s.m_x;
        for (std::size_t i = 0; i < u.size(); ++i) u[i] -= X[i];
        const std::complex<double> now(modalPart(mode, s.m_mass, u), modalPart(mode, s.m_mass, s.m_v) / mode.m_omega);
        phase -= std::arg(now / previous);
        previous = now;
    }
    // Both agree to 1e-6; an integrator without damping would have a decay of 0.
    const double wh = p.m_phaseStep, decay = 0.5 * n * std::log(1 + wh * wh);
    EXPECT_NEAR(phase / n, std::atan(wh), 1e-4 * std::atan(wh));
    EXPECT_NEAR(std::log(std::abs(previous) / amplitude), -decay, 1e-4 * decay);
}

std::string vibrationName(const testing::TestParamInfo<Vibration>& info)
{
    return info.param.m_name;
}
INSTANTIATE_TEST_SUITE_P(Modes, ElasticityVibration,
                         testing::Values(Vibration{"BendingSmallSteps", false, .05}, Vibration{"Bending", false, .2},
                                         Vibration{"Axial", true, .2}, Vibration{"AxialLargeSteps", true, .6}),
                         vibrationName);

}  // namespace
}  // namespace bullet_fem
