// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The dynamic beam: 4 x 1 x 1 m of Kuhn cells, clamped at x = 0, nu .3, rho 1000, beta .01, h 1/60, falls from rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "benchmarks/reference/warped_elements.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{
namespace
{

using Tips = std::array<double, 7>;  // height of the corner (4, 0, 0) [m] after several numbers of steps
constexpr std::array<int, 7> kTipSteps = {1, 11, 21, 31, 41, 51, 60};

struct Beam
{
    const char* m_name;
    int m_cellsAcross;
    double m_young;
    Tips m_reference;    // at 1e-8 without the tension term, by an independent prototype
    double m_roundOff;   // half a unit of the reference's last digit [m]
    Tips m_withTension;  // by this library, at 1e-8 with the tension term
};

void PrintTo(const Beam& beam, std::ostream* out)
{
    *out << beam.m_name;
}

struct BeamRun
{
    Tips m_tips = {};
    double m_worstResidual = 0;  // maximum |b - A dv| / |b| over the steps, computed here [-]
    double m_meanIterations = 0;
};

std::shared_ptr<const BodyModel> beamModel(const Beam& beam)
{
    Material material = elasticMaterial(beam.m_young, 0.3);
    material.m_stiffnessDamping = 0.01;
    const int n = beam.m_cellsAcross;
    return makeBody(makeBox({4, 1, 1}, {4 * n, n, n}, {}, CellSplit::kuhnSix), material,
                    [](const Vec3& X) { return X.x == 0; })
        .m_model;
}

double norm(const std::vector<Vec3>& u)
{
    double sum = 0;
    for (const Vec3& ui : u) sum += dot(ui, ui);
    return std::sqrt(sum);
}

// |b - A dv| / |b| of the last solve, with b and dv computed here from the state and the new velocities.
double trueResidual(const Body& body, const StepSettings& settings)
{
    const BodyState& s = body.m_state;
    const RestShape& shape = body.m_model->shape();
    const double h = settings.m_step;
    std::vector<Vec3> b = body.m_loads.m_force, dv = velocity(body), Adv(b.size());
    addElasticForces(shape, s.m_x, s.m_v, h + shape.m_material.m_stiffnessDamping, elementRotations(body), b, nullptr);
    for (std::size_t i = 0; i < b.size(); ++i)
    {
        b[i] *= s.m_fixed[i] ? 0 : h;
        dv[i] -= s.m_v[i];
    }
    WarpedSystem(body).apply(dv, Adv);
    std::vector<Vec3> r = b;
    for (std::size_t i = 0; i < b.size(); ++i) r[i] -= Adv[i];
    return norm(r) / norm(b);
}

BeamRun run(const std::shared_ptr<const BodyModel>& model, const StepSettings& settings)
{
    Body body(model);
    setGravity(body, {0, 0, -9.81});
    const int tip = nodeAt(model->mesh(), {4, 0, 0});
    BeamRun result;
    for (int k = 1; k <= kTipSteps.back(); ++k)
    {
        result.m_meanIterations += solveFreeMotion(body, settings).m_iterations / double(kTipSteps.back());
        result.m_worstResidual = std::max(result.m_worstResidual, trueResidual(body, settings));
        finishStep(body, settings);
        const auto listed = std::find(kTipSteps.begin(), kTipSteps.end(), k);
        if (listed != kTipSteps.end()) result.m_tips[listed - kTipSteps.begin()] = body.m_state.m_x[tip].z;
    }
    std::printf("%d tets, E %.0e, tolerance %.0e, %s warp, tension %s: worst residual %.2e, iterations %.2f, tips",
                model->mesh().tetCount(), model->shape().m_material.m_youngModulus, settings.m_tolerance,
                settings.m_warp == Warp::nodal ? "nodal" : "global", settings.m_tension ? "on" : "off",
                result.m_worstResidual, result.m_meanIterations);
    for (double z : result.m_tips) std::printf(" %.7f", z);
    std::printf("\n");
    return result;
}

StepSettings beamSettings(double tolerance, bool tension)
{
    StepSettings settings;
    settings.m_tolerance = tolerance;
    settings.m_tension = tension;
    return settings;
}

// Within max(0.1 %, 1e-5 m), the project's bound for every solver's tips.
void expectTips(const Tips& tips, const Tips& reference, double roundOff)
{
    for (std::size_t k = 0; k < tips.size(); ++k)
        EXPECT_NEAR(tips[k], reference[k], std::max(1e-3 * std::fabs(reference[k]), 1e-5) + roundOff)
            << "after " << kTipSteps[k] << " steps";
}

class ElasticityBeam : public testing::TestWithParam<Beam>
{
protected:
    // Checks the tolerances 1e-8, 1e-6 and 1e-3; the last one against this library's result at 1e-8.
    void expectDigits(const Tips& reference, double roundOff, bool tension);
};

void ElasticityBeam::expectDigits(const Tips& reference, double roundOff, bool tension)
{
    const auto model = beamModel(GetParam());
    const BeamRun tight = run(model, beamSettings(1e-8, tension));
    const BeamRun middle = run(model, beamSettings(1e-6, tension));
    const BeamRun loose = run(model, beamSettings(1e-3, tension));
    EXPECT_LE(tight.m_worstResidual, 1e-8);
    EXPECT_LE(middle.m_worstResidual, 1e-6);
    EXPECT_LE(loose.m_worstResidual, 1e-3);
    expectTips(tight.m_tips, reference, roundOff);
    expectTips(middle.m_tips, reference, roundOff);
    expectTips(loose.m_tips, tight.m_tips, 0);
    EXPECT_LE(loose.m_meanIterations, 3.2);  // documented for 12,288 tets at E = 1e6; the others need fewer
}

using ElasticityBeamSlow = ElasticityBeam;  // 12,288 tets

TEST_P(ElasticityBeam, MatchesTheReferenceDigits)
{
    expectDigits(GetParam().m_reference, GetParam().m_roundOff, false);
}
TEST_P(ElasticityBeam, MatchesItsOwnDigitsWithTension)
{
    expectDigits(GetParam().m_withTension, 5e-8, true);
}
TEST_P(ElasticityBeamSlow, MatchesTheReferenceDigits)
{
    expectDigits(GetParam().m_reference, GetParam().m_roundOff, false);
}
TEST_P(ElasticityBeamSlow, MatchesItsOwnDigitsWithTension)
{
    expectDigits(GetParam().m_withTension, 5e-8, true);
}

const Beam kCoarseSoft = {"Tets1536E1e6",
                          4,
                          1e6,
                          {-.0027, -.1933, -.7881, -1.6197, -2.3372, -2.8412, -3.0598},
                          5e-5,
                          {-.0027256, -.1933366, -.7877739, -1.6191832, -2.3366447, -2.8406416, -3.0601136}};
const Beam kCoarseStiff = {"Tets1536E1e7",
                           4,
                           1e7,
                           {-.0029, -.2109, -.4823, -.5202, -.3310, -.1533, -.1615},
                           5e-5,
                           {-.0029025, -.2108906, -.4823410, -.5208555, -.3321486, -.1536443, -.1608031}};
const Beam kFineSoft = {"Tets12288E1e6",
                        8,
                        1e6,
                        {-.0027252, -.1903987, -.7817914, -1.6440172, -2.3943814, -2.9187233, -3.1367230},
                        5e-8,
                        {-.0027252, -.1903949, -.7814209, -1.6433942, -2.3937731, -2.9178717, -3.1369924}};
const Beam kFineStiff = {"Tets12288E1e7",
                         8,
                         1e7,
                         {-.0028764, -.2177664, -.5308375, -.6332297, -.4684626, -.2281448, -.1462021},
                         5e-8,
                         {-.0028764, -.2177265, -.5307857, -.6338102, -.4698975, -.2291923, -.1459210}};

std::string beamName(const testing::TestParamInfo<Beam>& info)
{
    return info.param.m_name;
}
INSTANTIATE_TEST_SUITE_P(Both, ElasticityBeam, testing::Values(kCoarseSoft, kCoarseStiff), beamName);
INSTANTIATE_TEST_SUITE_P(Both, ElasticityBeamSlow, testing::Values(kFineSoft, kFineStiff), beamName);

TEST(ElasticityBeamSlow, GlobalWarpTakesFewIterations)
{
    StepSettings settings = beamSettings(1e-3, true);
    settings.m_warp = Warp::global;
    const BeamRun result = run(beamModel(kFineSoft), settings);
    EXPECT_LE(result.m_meanIterations, 5.5);
    EXPECT_LE(result.m_worstResidual, 1e-3);
}

}  // namespace
}  // namespace bullet_fem
