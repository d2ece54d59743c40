// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/motion/motion_figures.h"

#include <cmath>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "benchmarks/figures.h"
#include "benchmarks/motion/swinging_beam.h"

namespace bullet_fem
{
namespace
{

/// Texts of a case for tables and files.
struct Description
{
    MotionCase m_case;
    const char *m_name, *m_value, *m_unit, *m_about;
};

const Description g_descriptions[] = {
    {MotionCase::tip, "tip", "error", "-", "largest error of the beam's tip in a second / largest deflection"},
    {MotionCase::swing, "swing", "half-life", "s", "half-life of the amplitude of an undamped swing of 1.7 Hz"},
    {MotionCase::drop, "drop", "returns", "-", "rebound speed of an undamped ball dropped from a metre / impact speed"},
    {MotionCase::rebound, "rebound", "returns", "-", "the same for balls of 0.1, 1 and 10 MPa"},
    {MotionCase::roll10, "roll10", "speed", "m/s", "speed of a ball after six seconds down ten degrees"},
    {MotionCase::roll20, "roll20", "speed", "m/s", "speed of a ball after six seconds down twenty degrees"}};

const Description& describe(MotionCase motionCase)
{
    for (const Description& description : g_descriptions)
        if (description.m_case == motionCase) return description;
    throw std::logic_error("a case without description");
}

const char* nameOf(MotionMethod method)
{
    return method == MotionMethod::euler         ? "Euler"
           : method == MotionMethod::secondOrder ? "second order"
           : method == MotionMethod::standard    ? "default"
                                                 : "rigid";
}

double degreesOf(MotionCase motionCase)
{
    return motionCase == MotionCase::roll10 ? 10 : 20;
}

/// Measures cases that need no reference solution at their own step size.
Measured measure(MotionCase motionCase, MotionMethod method, int rate, int ballCells)
{
    std::cerr << nameOf(motionCase) << ", " << nameOf(method) << ", 1/" << rate << " s ..." << std::endl;
    switch (motionCase)
    {
        case MotionCase::swing:
            return swingBeam(method, rate);
        case MotionCase::drop:
            return dropBall(method, rate, ballCells);
        default:
            return rollBall(method, rate, ballCells, degreesOf(motionCase));
    }
}

std::vector<MotionFigures> measureTips(const std::vector<int>& rates, int referenceRate)
{
    std::cerr << nameOf(MotionCase::tip) << " ..." << std::endl;
    const FallingBeam reference = dropBeam(MotionMethod::secondOrder, referenceRate);
    std::vector<MotionFigures> rows;
    for (const MotionMethod method : {MotionMethod::euler, MotionMethod::secondOrder})
        for (const int rate : rates)
        {
            const FallingBeam beam = dropBeam(method, rate);
            rows.push_back({MotionCase::tip, method, rate, tipError(beam, reference), 0, beam.m_milliseconds, 0});
        }
    return rows;
}

std::vector<MotionFigures> measureRebounds(const std::vector<int>& rates, int referenceRate, int ballCells)
{
    std::vector<MotionFigures> rows;
    for (const double young : {1e5, 1e6, 1e7})
    {
        std::cerr << nameOf(MotionCase::rebound) << ", " << young << " Pa ..." << std::endl;
        const double reference = dropBall(MotionMethod::secondOrder, referenceRate, ballCells, young).m_value;
        for (const MotionMethod method : {MotionMethod::euler, MotionMethod::standard})
            for (const int rate : rates)
            {
                const Measured ball = dropBall(method, rate, ballCells, young);
                rows.push_back(
                    {MotionCase::rebound, method, rate, ball.m_value, reference, ball.m_milliseconds, young});
            }
    }
    return rows;
}

}  // namespace

const char* nameOf(MotionCase motionCase)
{
    return describe(motionCase).m_name;
}

MotionCase motionCase(const std::string& name)
{
    for (const Description& description : g_descriptions)
        if (name == description.m_name) return description.m_case;
    throw std::invalid_argument("--cases has " + name + ", must be of tip, swing, drop, rebound, roll10, roll20");
}

std::vector<MotionFigures> measureMotion(MotionCase motionCase, const std::vector<int>& rates, int referenceRate,
                                         int ballCells)
{
    if (motionCase == MotionCase::tip) return measureTips(rates, referenceRate);
    if (motionCase == MotionCase::rebound) return measureRebounds(rates, referenceRate, ballCells);
    const bool rolls = motionCase == MotionCase::roll10 || motionCase == MotionCase::roll20;
    double reference = std::numeric_limits<double>::infinity();  // the swing is undamped
    if (motionCase != MotionCase::swing)
        reference = measure(motionCase, MotionMethod::secondOrder, referenceRate, ballCells).m_value;
    std::vector<MotionFigures> rows;
    for (const MotionMethod method : {MotionMethod::euler, MotionMethod::secondOrder, MotionMethod::rigid})
        for (const int rate : rates)
        {
            const bool isRigid = method == MotionMethod::rigid;
            if (isRigid && !rolls) continue;
            const Measured value = measure(motionCase, method, rate, ballCells);
            rows.push_back({motionCase, method, rate, value.m_value,
                            isRigid ? speedOfRigidSphere(degreesOf(motionCase)) : reference, value.m_milliseconds, 0});
        }
    return rows;
}

void printTable(std::ostream& out, const std::vector<MotionFigures>& rows)
{
    const MotionFigures* previous = nullptr;
    for (const MotionFigures& row : rows)
    {
        const Description& about = describe(row.m_case);
        if (!previous || previous->m_case != row.m_case)
            print(out, "\n%s [%s]\n%-14s %6s  %10s %10s %10s  %9s\n", about.m_about, about.m_unit, "method", "1/h",
                  about.m_value, "reference", "ratio", "CPU ms");
        const bool hasRatio = std::isfinite(row.m_reference) && row.m_reference > 0;
        print(out, "%-14s %6d  %10.4g %10.4g ", nameOf(row.m_method), row.m_rate, row.m_value, row.m_reference);
        if (hasRatio)
            print(out, "%10.3f", row.m_value / row.m_reference);
        else
            print(out, "%10s", "-");
        print(out, "  %9.3f\n", row.m_milliseconds);
        previous = &row;
    }
}

nlohmann::json toJson(const std::vector<MotionFigures>& rows)
{
    nlohmann::json results = nlohmann::json::array();
    for (const MotionFigures& row : rows)  // infinite values become null
        results.push_back({{"case", nameOf(row.m_case)},
                           {"method", nameOf(row.m_method)},
                           {"steps_per_second", row.m_rate},
                           {"value", row.m_value},
                           {"unit", describe(row.m_case).m_unit},
                           {"reference", row.m_reference},
                           {"young", row.m_young},
                           {"ms_cpu_median", row.m_milliseconds}});
    return results;
}

}  // namespace bullet_fem
