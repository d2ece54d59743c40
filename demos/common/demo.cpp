// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/common/demo.h"

#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>

#include "demos/common/demo_film.h"
#include "tools/console/option_range.h"

namespace bullet_fem
{
namespace
{

constexpr int kGood = 0, kFailed = 1;
constexpr double kRounding = 1e-9;  // [s]; rounding error of a sum of steps

std::string formatted(const char* format, double a, const std::string& unit)
{
    char text[64];
    std::snprintf(text, sizeof text, format, a);
    return text + (unit.empty() ? "" : " " + unit);
}

std::string row(const std::string& what, const std::string& value)
{
    std::string name = "  " + what;
    if (name.size() < 34) name.resize(34, ' ');
    return name + " " + value;
}

int tetsIn(const btDynamicsWorld& world)
{
    int tets = 0;
    for (int k = 0; k < world.getNumCollisionObjects(); ++k)
        if (const btSoftBody* body = btSoftBody::upcast(world.getCollisionObjectArray()[k]))
            tets += body->m_tetras.size();
    return tets;
}

}  // namespace

Demo::Demo(const std::string& name, const std::string& what, double seconds)
    : m_name(name),
      m_seconds(seconds),
      m_options(std::make_unique<CLI::App>(what)),
      m_film(std::make_unique<DemoFilm>())
{
    m_options->footer("Exit code: 1 if a check at the end failed, 2 on a bad option.");
    m_options->option_defaults()->take_last()->always_capture_default(true);
    m_options->add_option("--seconds", m_seconds, "time to simulate [s]")->check(inRange(1e-3, 3600));
    m_options->add_option("--out", m_folder,
                          "folder for a ParaView series, three pictures and a film; nothing is written without it");
}

Demo::~Demo() = default;

void Demo::option(const std::string& name, double& value, double low, double high, const std::string& what)
{
    m_options->add_option(name, value, what)->check(inRange(low, high));
}

void Demo::flag(const std::string& name, bool& value, const std::string& what)
{
    m_options->add_flag(name, value, what)->disable_flag_override();
}

void Demo::option(const std::string& name, std::string& value, const std::string& what)
{
    m_options->add_option(name, value, what);
}

int Demo::run(int argc, char** argv, const std::function<void()>& scene)
{
    try
    {
        m_options->parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return m_options->exit(error) == 0 ? kGood : kUsageError;
    }
    try
    {
        if (!m_folder.empty()) m_film->open(m_folder, m_seconds);
        scene();
        const std::vector<std::string> written = m_film->finish();
        printTable();
        for (const std::string& path : written) std::printf("written: %s\n", path.c_str());
        return m_failed ? kFailed : kGood;
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "%s: %s\n", m_name.c_str(), error.what());
        return kFailed;
    }
}

void Demo::look(const btVector3& eye, const btVector3& target, double fieldOfView)
{
    m_film->look(eye, target, fieldOfView);
}

void Demo::paint(const btCollisionObject& object, const Vec3& colour)
{
    m_film->paint(object, colour);
}

void Demo::drawBeside(const btDynamicsWorld* world)
{
    m_film->drawBeside(world);
}

bool Demo::step(btDynamicsWorld& world, double h)
{
    m_film->show(world, m_time);
    if (m_time + h > m_seconds + kRounding) return false;
    const std::clock_t start = std::clock();
    world.stepSimulation(btScalar(h), 0);  // 0: one step of exactly this size
    m_stepSeconds += double(std::clock() - start) / CLOCKS_PER_SEC;
    m_time += h;
    ++m_steps;
    m_tets = tetsIn(world);
    return true;
}

void Demo::figure(const std::string& what, double value, const std::string& unit)
{
    m_lines.push_back(row(what, formatted("%.4g", value, unit)));
}

void Demo::check(const std::string& what, double value, double low, double high, const std::string& unit, double from)
{
    if (m_time + kRounding < from)
    {
        m_checks.push_back(row(what, formatted("left out: needs --seconds %.4g", from, "")));
        return;
    }
    const bool good = value >= low && value <= high;  // NaN gives false
    m_failed = m_failed || !good;
    m_checks.push_back(row(what, (good ? "ok: " : "FAILED: ") + formatted("%.4g", value, unit) +
                                     formatted(", in [%.4g, ", low, "") + formatted("%.4g]", high, "")));
}

void Demo::printTable() const
{
    std::printf("%s\n", m_name.c_str());
    std::printf("%s\n", row("elements", formatted("%.0f", m_tets, "")).c_str());
    std::printf("%s\n", row("steps", formatted("%.0f", m_steps, "")).c_str());
    if (m_steps > 0)
        std::printf("%s\n",
                    row("processor time a step", formatted("%.2f", 1e3 * m_stepSeconds / m_steps, "ms")).c_str());
    for (const std::string& line : m_lines) std::printf("%s\n", line.c_str());
    std::printf("checks\n");
    for (const std::string& line : m_checks) std::printf("%s\n", line.c_str());
}

}  // namespace bullet_fem
