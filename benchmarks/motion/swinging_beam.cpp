// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/motion/swinging_beam.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "benchmarks/beam/beam_case.h"
#include "benchmarks/beam/fem_beam.h"
#include "benchmarks/figures.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

constexpr int kFrames = 30;            // per second, at which tip positions are compared
constexpr double kFrequency = 1.7;     // of the oscillation [Hz]
constexpr double kSwingSeconds = 10;   // [s]
constexpr double kFirstSeconds = 0.6;  // one period, whose maximum energy is the initial one [s]
constexpr double kWeight = 0.3;        // acceleration that bends the beam initially, along y and along z [m/s2]
constexpr double kTolerance = 1e-6;    // of the linear solves
constexpr double kBeamYoung = 1e7;     // [Pa]
constexpr double kBeamDensity = 1000;  // [kg/m3]
// The diagonals of the elements lie along y = z. Bending along y or z alone would excite two modes that beat.
const Vec3 g_weight = {0, -kWeight, -kWeight};

Material elastic(double youngModulus)
{
    Material material;
    material.m_youngModulus = youngModulus;
    material.m_poissonRatio = 0.3;
    material.m_density = kBeamDensity;
    material.m_stiffnessDamping = 0;
    return material;
}

StepSettings settingsOf(double step, double numericalDamping)
{
    StepSettings settings;
    settings.m_step = step;
    settings.m_numericalDamping = numericalDamping;
    settings.m_tolerance = kTolerance;
    return settings;
}

double dampingOf(MotionMethod method)
{
    return method == MotionMethod::secondOrder ? 0 : 1;
}

Body bodyOf(BeamCase beam, const StepSettings& settings)
{
    beam.m_step = factorStep(settings.m_step, settings.m_numericalDamping, beam.m_material);
    return Body(makeBeamModel(beam));
}

void load(Body& body, const Vec3& gravity)
{
    for (std::size_t i = 0; i < body.m_loads.m_force.size(); ++i)
        body.m_loads.m_force[i] = body.m_state.m_mass[i] * gravity;
}

/// Static deflection under a small weight: the first mode up to some percent.
std::vector<Vec3> bentShape(const BeamCase& beam)
{
    StepSettings settings = settingsOf(1, 1);  // long steps of implicit Euler converge to rest
    settings.m_tolerance = 1e-9;
    Body body = bodyOf(beam, settings);
    load(body, g_weight);
    for (int k = 0; k < 40; ++k) step(body, settings);
    std::vector<Vec3> bent(beam.m_positions.size());
    for (std::size_t i = 0; i < bent.size(); ++i) bent[i] = body.m_state.m_x[i] - beam.m_positions[i];
    return bent;
}

/// Projection of the state on a shape u: sum m u . d / sum m u . u.
double shareOf(const std::vector<Vec3>& shape, const std::vector<double>& mass, const std::vector<Vec3>& of,
               const std::vector<Vec3>& from)
{
    double part = 0, whole = 0;
    for (std::size_t i = 0; i < shape.size(); ++i)
    {
        part += mass[i] * dot(shape[i], of[i] - from[i]);
        whole += mass[i] * dot(shape[i], shape[i]);
    }
    return part / whole;
}

/// omega^2 of a shape under the weight that bends it, by Rayleigh's quotient [1/s2].
double omegaSquare(const BeamCase& beam, const std::vector<Vec3>& bent)
{
    const std::vector<double> mass = lumpedNodeMasses(beam);
    double work = 0, inertia = 0;
    for (std::size_t i = 0; i < bent.size(); ++i)
    {
        work += mass[i] * dot(g_weight, bent[i]);
        inertia += mass[i] * dot(bent[i], bent[i]);
    }
    return work / inertia;
}

/// The beam whose first bending mode has that frequency; the frequency squared is proportional to Young's modulus.
BeamCase beamOfFrequency(double frequency)
{
    BeamCase beam = makeBeamCase(beamCells(192), elastic(kBeamYoung));
    const double omega = 2 * std::acos(-1) * frequency;
    const double have = omegaSquare(beam, bentShape(beam));
    beam.m_material.m_youngModulus *= omega * omega / have;
    return beam;
}

}  // namespace

FallingBeam dropBeam(MotionMethod method, int rate)
{
    const StepSettings settings = settingsOf(1.0 / rate, dampingOf(method));
    const BeamCase beam = makeBeamCase(beamCells(1536), elastic(kBeamYoung));
    Body body = bodyOf(beam, settings);
    load(body, beam.m_gravity);
    FallingBeam fall;
    std::vector<double> milliseconds;
    for (int k = 1; k <= rate; ++k)
    {
        const Stopwatch watch;
        step(body, settings);
        milliseconds.push_back(1e3 * watch.cpuSeconds());
        if (k % (rate / kFrames) == 0) fall.m_tipHeights.push_back(body.m_state.m_x[beam.m_tipNode].z);
    }
    fall.m_milliseconds = median(milliseconds);
    return fall;
}

double tipError(const FallingBeam& beam, const FallingBeam& reference)
{
    double error = 0, deflection = 0;
    for (std::size_t k = 0; k < reference.m_tipHeights.size(); ++k)
    {
        error = std::max(error, std::fabs(beam.m_tipHeights[k] - reference.m_tipHeights[k]));
        deflection = std::max(deflection, std::fabs(reference.m_tipHeights[k]));
    }
    return error / deflection;
}

Measured swingBeam(MotionMethod method, int rate)
{
    const StepSettings settings = settingsOf(1.0 / rate, dampingOf(method));
    const BeamCase beam = beamOfFrequency(kFrequency);
    const std::vector<Vec3> bent = bentShape(beam), still(beam.m_positions.size());
    Body body = bodyOf(beam, settings);
    const BodyState& s = body.m_state;
    for (std::size_t i = 0; i < bent.size(); ++i) body.m_state.m_x[i] += bent[i];
    const double omega = std::sqrt(omegaSquare(beam, bent));
    double first = 0, last = 0;  // maximum energies of the first and of the last period
    std::vector<double> milliseconds;
    const int steps = static_cast<int>(std::lround(kSwingSeconds * rate));
    const int period = static_cast<int>(std::lround(kFirstSeconds * rate));
    for (int k = 0; k < steps; ++k)
    {
        const Stopwatch watch;
        step(body, settings);
        milliseconds.push_back(1e3 * watch.cpuSeconds());
        const double x = omega * shareOf(bent, s.m_mass, s.m_x, beam.m_positions);
        const double v = shareOf(bent, s.m_mass, s.m_v, still);
        if (k < period) first = std::max(first, x * x + v * v);
        if (k >= steps - period) last = std::max(last, x * x + v * v);
    }
    const double lost = 0.5 * std::log(first / last);  // logarithmic decrease of the amplitude
    const double time = kSwingSeconds - kFirstSeconds;
    return {lost > 0 ? time * std::log(2.0) / lost : std::numeric_limits<double>::infinity(), median(milliseconds)};
}

}  // namespace bullet_fem
