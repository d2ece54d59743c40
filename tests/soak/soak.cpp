// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Random programs in all worlds, couplings and manners, without end. A failing program is minimised and reported with
// the command that repeats it.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "soak/child_run.h"
#include "soak/minimise.h"
#include "soak/soak_case.h"
#include "soak/trace.h"
#include "tools/console/option_range.h"
#include "tools/console/program.h"

namespace
{
using namespace bullet_fem;

// Set by SIGINT or SIGTERM: the running program is the last one.
volatile std::sig_atomic_t isEnding = 0;

void endSoon(int)
{
    isEnding = 1;
}

struct Options
{
    unsigned m_first = 1;
    double m_seconds = 60;
    long m_steps = 1000000000;
    int m_acts = 300, m_maxSeconds = 120, m_maxFaults = 20;
    std::string m_only;  // acts of one program
    bool m_oneProgram = false, m_isTraced = false;
};

struct Sums
{
    long m_programs = 0, m_steps = 0, m_refusals = 0, m_faults = 0;

    void add(const SoakOutcome& outcome)
    {
        ++m_programs;
        m_steps += outcome.m_steps;
        m_refusals += outcome.m_refusals;
        m_faults += !outcome.m_fault.empty();
    }
};

double secondsSince(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string listed(const std::vector<int>& acts)
{
    std::string text;
    for (const int act : acts) text += (text.empty() ? "" : ",") + std::to_string(act);
    return text;
}

std::vector<int> numbersOf(const std::string& text)
{
    std::vector<int> numbers;
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');) numbers.push_back(std::stoi(word));
    return numbers;
}

SoakOutcome runCase(const SoakCase& soak, const Options& options)
{
    return runInChild([&] { return run(soak); }, options.m_maxSeconds);
}

// The minimiser accepts any fault, because messages contain the number of the act.
void tell(SoakCase soak, const SoakOutcome& outcome, const Options& options)
{
    constexpr int kMaxRuns = 300;
    std::printf("%s: %s\n", nameOf(soak).c_str(), outcome.m_fault.c_str());
    std::fflush(stdout);
    const auto fails = [&](const std::vector<int>& acts)
    {
        soak.m_acts = acts;
        return !runCase(soak, options).m_fault.empty();
    };
    const std::vector<int> few = isEnding ? soak.m_acts : minimise(soak.m_acts, fails, kMaxRuns);
    soak.m_acts = few;
    std::printf("  with %zu acts: %s\n  bulletfem_soak --program %u --only %s\n", few.size(),
                runCase(soak, options).m_fault.c_str(), soak.m_number, listed(few).c_str());
    std::fflush(stdout);
}

bool soakAll(const Options& options)
{
    const auto begin = std::chrono::steady_clock::now();
    Sums all;
    std::map<std::string, Sums> kinds;
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, endSoon);
    const auto goesOn = [&]
    { return !isEnding && secondsSince(begin) < options.m_seconds && all.m_steps < options.m_steps; };
    for (unsigned k = options.m_first; goesOn(); ++k)
    {
        const SoakCase soak = soakCase(k, options.m_acts);
        const SoakOutcome outcome = runCase(soak, options);
        all.add(outcome);
        const std::string name = nameOf(soak);
        kinds[name.substr(0, name.rfind(' '))].add(outcome);
        if (outcome.m_fault.empty()) continue;
        tell(soak, outcome, options);
        if (all.m_faults >= options.m_maxFaults) break;
    }
    kinds["all"] = all;
    std::printf("%-28s %9s %10s %9s %7s\n", "", "programs", "steps", "refusals", "faults");
    for (const auto& [name, sums] : kinds)
        std::printf("%-28s %9ld %10ld %9ld %7ld\n", name.c_str(), sums.m_programs, sums.m_steps, sums.m_refusals,
                    sums.m_faults);
    std::printf("programs %u to %u, %d acts each, %.0f s\n", options.m_first,
                static_cast<unsigned>(options.m_first + all.m_programs - 1), options.m_acts, secondsSince(begin));
    return all.m_faults == 0;
}

// Runs in this process, for a debugger.
bool repeat(const Options& options)
{
    SoakCase soak = soakCase(options.m_first, options.m_acts);
    if (!options.m_only.empty()) soak.m_acts = numbersOf(options.m_only);
    const SoakOutcome outcome = run(soak, options.m_isTraced ? printTrace : nullptr);
    std::printf("%s: %ld steps, %d refusals, %s\n", nameOf(soak).c_str(), outcome.m_steps, outcome.m_refusals,
                outcome.m_fault.empty() ? "no fault" : outcome.m_fault.c_str());
    return outcome.m_fault.empty();
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Runs random programs and looks whether they stay sound", "bulletfem_soak");
    app.add_option("--first", options.m_first, "number of the first program")->capture_default_str();
    CLI::Option* program = app.add_option("--program", options.m_first, "run this one alone, in this process");
    app.add_option("--only", options.m_only, "its acts, in place of all: 3,17,40")->needs(program);
    app.add_flag("--trace", options.m_isTraced, "print every act, and where it leaves the bodies")->needs(program);
    app.add_option("--seconds", options.m_seconds, "begin no program after so long [s]")
        ->check(inRange(0, 1e7))
        ->capture_default_str();
    app.add_option("--steps", options.m_steps, "or after so many steps")->check(CLI::PositiveNumber);
    app.add_option("--acts", options.m_acts, "acts a program")->check(CLI::Range(1, 1000000))->capture_default_str();
    app.add_option("--limit", options.m_maxSeconds, "a program that takes more processor time is a fault [s]")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    app.footer(
        "SIGINT (Ctrl-C) and SIGTERM end it after the program that runs, with its sums.\n"
        "Exit code 0 if no program failed, 1 if one did, 2 on bad usage.");
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return app.exit(error) == 0 ? 0 : kUsageError;
    }
    options.m_oneProgram = program->count() > 0;
    return runProgram("bulletfem_soak",
                      [&] { return (options.m_oneProgram ? repeat(options) : soakAll(options)) ? 0 : 1; });
}
