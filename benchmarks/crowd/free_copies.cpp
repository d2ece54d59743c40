// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/crowd/free_copies.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "benchmarks/figures.h"
#include "bullet_fem/fem/batch/batch_memory.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

constexpr double kCopySide = 0.2;  // edge of a cube [m]
constexpr double kKick = 10;       // approximate speed of the corners after a kick [m/s]
constexpr int kKickSteps = 20;     // steps between kicks, which keep the bodies in motion

std::shared_ptr<const BodyModel> makeModel(const FreeCopiesSettings& settings)
{
    const int n = settings.m_cells;
    Material material;
    material.m_youngModulus = settings.m_young;
    material.m_stiffnessDamping = 0.002;
    const auto shape =
        std::make_shared<const RestShape>(makeBox({kCopySide, kCopySide, kCopySide}, {n, n, n}), material);
    FactorInput input;
    input.m_mass = shape->m_lumpedMass;
    input.m_step = StepSettings().m_step / settings.m_stale;
    input.m_fixed.assign(shape->m_mesh.nodeCount(), 0);
    return BodyModel::create(shape, input);
}

/// Bodies in different twisting, bending and spinning motions.
class Copies
{
public:
    Copies(const std::shared_ptr<const BodyModel>& model, const FreeCopiesSettings& settings)
    {
        m_step.m_tolerance = settings.m_tolerance;
        m_step.m_batchMemory = &m_memory;
        for (int k = 0; k < settings.m_bodies; ++k)
        {
            m_bodies.emplace_back(model);
            BodyState& state = m_bodies.back().m_state;
            for (std::size_t i = 0; i < state.m_mass.size(); ++i)
                m_bodies.back().m_loads.m_force[i] = {0, 0, -9.81 * state.m_mass[i]};
        }
        for (Body& body : m_bodies) m_motions.push_back({&body, m_step, {}});
    }

    // Sets velocities that twist the body about one axis and bend it about another.
    void kick()
    {
        const double rate = kKick / (0.25 * kCopySide * kCopySide);  // [1/(m s)]
        for (std::size_t k = 0; k < m_bodies.size(); ++k)
        {
            BodyState& state = m_bodies[k].m_state;
            const std::vector<Vec3>& X = m_bodies[k].m_model->mesh().restPositions();
            const double twist = rate * (1 + 0.5 * std::sin(3.0 * k)), bend = rate * (1 + 0.5 * std::cos(5.0 * k));
            for (std::size_t i = 0; i < X.size(); ++i)
            {
                const Vec3 r = X[i] - 0.5 * Vec3{kCopySide, kCopySide, kCopySide};
                state.m_v[i] += Vec3{-twist * r.z * r.y, twist * r.z * r.x, bend * r.x * r.x};
            }
        }
    }

    void stepTogether() { solveFreeMotions(m_motions.data(), static_cast<int>(m_motions.size())), finish(); }

    void stepAlone()
    {
        for (FreeMotion& motion : m_motions) motion.m_report = solveFreeMotion(*motion.m_body, m_step);
        finish();
    }

    double iterations() const
    {
        double sum = 0;
        for (const FreeMotion& motion : m_motions) sum += motion.m_report.m_iterations;
        return sum / static_cast<double>(m_motions.size());
    }

    bool hasBitsOf(const Copies& other) const
    {
        const auto same = [](const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
        for (std::size_t k = 0; k < m_bodies.size(); ++k)
        {
            const BodyState &a = m_bodies[k].m_state, &b = other.m_bodies[k].m_state;
            if (!std::equal(a.m_x.begin(), a.m_x.end(), b.m_x.begin(), same)) return false;
            if (!std::equal(a.m_v.begin(), a.m_v.end(), b.m_v.begin(), same)) return false;
        }
        return true;
    }

private:
    void finish()
    {
        for (Body& body : m_bodies) finishStep(body, m_step);
    }

    StepSettings m_step;
    BatchMemory m_memory;
    std::vector<Body> m_bodies;
    std::vector<FreeMotion> m_motions;
};

template <class Work>
double milliseconds(const Work& work)
{
    const Stopwatch watch;
    work();
    return 1e3 * watch.cpuSeconds();
}

}  // namespace

FreeCopiesFigures measureFreeCopies(const FreeCopiesSettings& settings)
{
    const auto model = makeModel(settings);
    Copies together(model, settings), alone(model, settings);
    std::vector<double> togetherTimes, aloneTimes;
    FreeCopiesFigures figures;
    figures.m_settings = settings;
    figures.m_tets = model->mesh().tetCount();
    figures.m_factorMegabytes = 1e-6 * static_cast<double>(model->factorReport().m_bytes);
    for (int begin = 0; begin < settings.m_steps; begin += kKickSteps)
    {
        const int count = std::min(kKickSteps, settings.m_steps - begin);
        together.kick();
        for (int k = 0; k < count; ++k)
        {
            togetherTimes.push_back(milliseconds([&] { together.stepTogether(); }));
            figures.m_iterations += together.iterations() / settings.m_steps;
        }
        alone.kick();
        for (int k = 0; k < count; ++k) aloneTimes.push_back(milliseconds([&] { alone.stepAlone(); }));
    }
    figures.m_togetherMilliseconds = median(togetherTimes);
    figures.m_aloneMilliseconds = median(aloneTimes);
    figures.m_sameBits = together.hasBitsOf(alone);
    return figures;
}

void printTable(std::ostream& out, const std::vector<FreeCopiesFigures>& rows)
{
    print(out, "%6s %6s %9s %9s %9s  %8s  %11s %9s %7s  %s\n", "bodies", "tets", "factor MB", "E Pa", "stale",
          "it./step", "together ms", "alone ms", "ratio", "bits");
    for (const FreeCopiesFigures& row : rows)
        print(out, "%6d %6d %9.2f %9.0e %9.0f  %8.2f  %11.3f %9.3f %7.2f  %s\n", row.m_settings.m_bodies, row.m_tets,
              row.m_factorMegabytes, row.m_settings.m_young, row.m_settings.m_stale, row.m_iterations,
              row.m_togetherMilliseconds, row.m_aloneMilliseconds, row.ratio(), row.m_sameBits ? "same" : "DIFFERENT");
}

nlohmann::json toJson(const std::vector<FreeCopiesFigures>& rows)
{
    nlohmann::json results = nlohmann::json::array();
    for (const FreeCopiesFigures& row : rows)
        results.push_back({{"bodies", row.m_settings.m_bodies},
                           {"tets", row.m_tets},
                           {"factor_mb", row.m_factorMegabytes},
                           {"young_pa", row.m_settings.m_young},
                           {"tolerance", row.m_settings.m_tolerance},
                           {"stale", row.m_settings.m_stale},
                           {"iterations_mean", row.m_iterations},
                           {"ms_together_median", row.m_togetherMilliseconds},
                           {"ms_alone_median", row.m_aloneMilliseconds},
                           {"ratio", row.ratio()},
                           {"same_bits", row.m_sameBits}});
    return results;
}

}  // namespace bullet_fem
