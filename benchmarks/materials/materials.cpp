// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Response of bars of the material laws, compared with the formulas of docs/materials.md.
#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "benchmarks/figures.h"
#include "benchmarks/json_file.h"
#include "benchmarks/materials/bar.h"
#include "bullet_fem/fem/step/stress.h"
#include "tools/console/program.h"

namespace
{
using namespace bullet_fem;

constexpr double kYoung = 1e6;                        // of rate-dependent materials [Pa]
constexpr double kLongStep = 0.05, kStep = 1.0 / 60;  // [s]

// Measured values and those of the formula, for each abscissa.
struct Curve
{
    std::string m_figure, m_name;
    std::vector<double> m_x, m_measured, m_formula;

    void add(double x, double measured, double formula)
    {
        m_x.push_back(x);
        m_measured.push_back(measured);
        m_formula.push_back(formula);
    }
    double largestError() const
    {
        double error = 0, scale = 0;
        for (std::size_t i = 0; i < m_x.size(); ++i)
        {
            error = std::max(error, std::fabs(m_measured[i] - m_formula[i]));
            scale = std::max(scale, std::fabs(m_formula[i]));
        }
        return error / scale;
    }
};

Material elastic(double young, double poisson, double density = 1000)
{
    Material material;
    material.m_youngModulus = young;
    material.m_poissonRatio = poisson;
    material.m_density = density;
    material.m_massDamping = material.m_stiffnessDamping = 0;
    return material;
}

// Tension beyond the yield stress, unloading, compression beyond it: isotropic hardening.
Curve yieldCurve()
{
    constexpr double kYield = 1e3, kHardening = 0.25 * kYoung;
    Curve curve = {"yield", "hardens by E/4", {}, {}, {}};
    Material material = elastic(kYoung, 0.3);
    material.m_yieldStress = kYield;
    material.m_hardeningModulus = kHardening;
    Bar bar(makeBox({1, 0.25, 0.25}, {4, 1, 1}, {}, CellSplit::kuhnSix), material, kLongStep);
    double flow = kYield, plastic = 0, stress = 0;
    const auto go = [&](double to)
    {
        const double from = stress;
        for (int k = 1; k <= 15; ++k)
        {
            stress = from + (to - from) * k / 15;
            bar.settle([&] { bar.pull(stress); });
            if (std::fabs(stress) > flow)
            {
                plastic += std::copysign((std::fabs(stress) - flow) / kHardening, stress);
                flow = std::fabs(stress);
            }
            curve.add(bar.strain(), stress, (stress / kYoung + plastic - bar.strain()) * kYoung + stress);
        }
    };
    for (const double to : {2 * kYield, -2.5 * kYield, 0.0}) go(to);
    return curve;
}

// Stress relaxation after a sudden shear strain; Prony series of three terms.
Curve relaxationCurve()
{
    Curve curve = {"relaxation", "three terms", {}, {}, {}};
    Material material = elastic(kYoung, 0.3);
    material.m_relaxation = {{{0.3, 0.1}, {0.2, 1}, {0.1, 7}}};
    Bar bar(makeBox({1, 0.5, 0.5}, {2, 1, 1}, {}, CellSplit::kuhnSix), material, kStep,
            [](const Vec3&) { return true; });
    for (Vec3& x : bar.body().m_state.m_x) x.x += 0.05 * x.z;
    const double first = vonMises(elementStress(bar.body(), 0));
    for (int k = 1; k <= 720; ++k)
    {
        bar.step();
        const double t = k * kStep;
        double left = 1;
        for (const PronyTerm& term : material.m_relaxation) left -= term.m_share * -std::expm1(-t / term.m_time);
        if (k % 6 == 0 || k < 12) curve.add(t, vonMises(elementStress(bar.body(), 0)) / first, left);
    }
    return curve;
}

// Nominal uniaxial stress of a Neo-Hookean bar with free lateral faces [Pa].
double neoHookeStress(const Material& material, double stretch)
{
    const double mu = material.lameMu(), lambda = material.lameLambda();
    const auto stress = [&](double along, double J)
    { return mu * (along - 1 / along) + lambda / 2 * (J * J - 1) / along; };
    double low = 0.01, high = 2;
    for (int k = 0; k < 60; ++k)
    {
        const double width = (low + high) / 2;
        (stress(width, stretch * width * width) > 0 ? high : low) = width;
    }
    return stress(stretch, stretch * low * low);
}

// Tension to twice the length.
Curve largeStrainCurve(const char* name, ElasticLaw law)
{
    Curve curve = {"large strain", name, {}, {}, {}};
    Material material = elastic(kYoung, 0.3);
    material.m_law = law;
    Bar bar(makeBox({1, 0.25, 0.25}, {4, 1, 1}, {}, CellSplit::kuhnSix), material, kLongStep);
    for (int k = 0; k <= 16 && bar.strain() < 1; ++k)
    {
        const double stress = kYoung * k / 16;
        bar.settle([&] { bar.pull(stress); });
        const double strain = bar.strain();
        const bool isHooke = law == ElasticLaw::hooke;
        const double formula = isHooke ? kYoung * strain : neoHookeStress(material, 1 + strain);
        curve.add(1 + strain, stress / kYoung, formula / kYoung);
    }
    return curve;
}

// Tip deflection of a clamped bar of 10 x 1 x 1 with n cells across, relative to Timoshenko's beam theory.
Curve tipCurve(const char* name, int cells, MeanDilatation dilatation, bool isAccurate = false)
{
    constexpr double kLength = 10, kForce = 1e-3;
    Curve curve = {"tip", name, {}, {}, {}};
    for (const double nu : {0.0, 0.2, 0.3, 0.4, 0.45, 0.48, 0.49, 0.495, 0.499})
    {
        Material material = elastic(kYoung, nu, 1e-3);
        material.m_meanDilatation = dilatation;
        material.m_bending = isAccurate ? Bending::accurate : Bending::plain;
        Bar bar(makeBox({kLength, 1, 1}, {10 * cells, cells, cells}, {}, CellSplit::kuhnSix), material, 1,
                [](const Vec3& X) { return X.x < 1e-9; });
        const double before = bar.endPosition().z;
        bar.load({0, 0, -kForce});
        bar.settle();
        const double shear = kYoung / (2 * (1 + nu)), correction = 10 * (1 + nu) / (12 + 11 * nu);
        const double tip = kForce * (kLength * kLength * kLength * 4 / kYoung + kLength / (correction * shear));
        curve.add(nu, (before - bar.endPosition().z) / tip, 1);
    }
    return curve;
}

std::vector<Curve> measure()
{
    return {yieldCurve(),
            relaxationCurve(),
            largeStrainCurve("Hooke, corotational", ElasticLaw::hooke),
            largeStrainCurve("Neo-Hookean", ElasticLaw::neoHooke),
            tipCurve("m_meanDilatation off", 4, MeanDilatation::off),
            tipCurve("m_meanDilatation on", 4, MeanDilatation::on),
            tipCurve("m_bending accurate", 4, MeanDilatation::on, true)};
}

nlohmann::json toJson(const std::vector<Curve>& curves)
{
    nlohmann::json rows = nlohmann::json::array();
    for (const Curve& c : curves)
        rows.push_back({{"figure", c.m_figure},
                        {"name", c.m_name},
                        {"x", c.m_x},
                        {"measured", c.m_measured},
                        {"formula", c.m_formula}});
    return rows;
}

}  // namespace

int main(int argc, char** argv)
{
    std::string jsonFile;
    CLI::App app("Compares bars of the materials with the formulas", "bulletfem_bench_materials");
    app.add_option("--json", jsonFile, "write the curves to this file");
    app.footer(
        "Example, the picture of docs/materials.md:\n  bulletfem_bench_materials --json materials.json\n"
        "  tools/plot_materials.py materials.json docs/materials.png");
    CLI11_PARSE(app, argc, argv);
    return runProgram("bulletfem_bench_materials",
                      [&]
                      {
                          JsonFile json(jsonFile);
                          const MachineInfo machine = readMachineInfo(1);
                          const std::vector<Curve> curves = measure();
                          std::cout << toText(machine) << "\n";
                          print(std::cout, "%-12s %-36s %7s %20s\n", "figure", "curve", "points",
                                "error / largest [%]");
                          for (const Curve& c : curves)
                              print(std::cout, "%-12s %-36s %7d %20.2f\n", c.m_figure.c_str(), c.m_name.c_str(),
                                    static_cast<int>(c.m_x.size()), 100 * c.largestError());
                          json.write(machine, {{"curves", toJson(curves)}});
                          return 0;
                      });
}
