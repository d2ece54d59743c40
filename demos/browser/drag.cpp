// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The scene of the browser page without a browser, for this machine or for node.js: drops the body, lifts it with the
// mouse's spring, releases it, and waits until it rests. Prints results; exit code 1 if a check fails.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <vector>

#include "demos/browser/scene.h"

namespace
{

constexpr int kStand = 180, kLift = 120, kSettle = 240, kHold = 240, kMax = 3600;  // steps
constexpr double kHeight = 1.6;                                                    // vertical path of the mouse [m]

bool failed = false;
std::vector<double> stepMs;  // processor time of each step since the last printed line

void check(const char* what, double value, double low, double high)
{
    const bool holds = value >= low && value <= high;
    failed = failed || !holds;
    std::printf("  %-34s %10.4g  in [%g, %g]%s\n", what, value, low, high, holds ? "" : "  FAILED");
}

double processorMs()
{
#ifdef __EMSCRIPTEN__  // its std::clock gives wall time
    return EM_ASM_DOUBLE({
        const used = process.cpuUsage();
        return (used.user + used.system) / 1000;
    });
#else
    return 1000.0 * double(std::clock()) / CLOCKS_PER_SEC;
#endif
}

void step(int count)
{
    for (int k = 0; k < count; ++k)
    {
        const double began = processorMs();
        scene_step();
        stepMs.push_back(processorMs() - began);
    }
}

/// Prints the median.
void printStepMs(const char* what)
{
    std::sort(stepMs.begin(), stepMs.end());
    std::printf("  %-34s %10.3f  ms\n", what, stepMs[stepMs.size() / 2]);
    stepMs.clear();
}

/// FNV-1a hash of the surface's bits, for tests of bitwise equality.
std::uint64_t bits()
{
    std::uint64_t hash = 14695981039346656037ull;
    const float* vertices = scene_vertices();
    for (int v = 0; v < scene_vertex_count(); ++v)
        for (int c = 0; c < 3; ++c)
        {
            std::uint32_t word;
            std::memcpy(&word, &vertices[6 * v + c], sizeof word);
            hash = (hash ^ word) * 1099511628211ull;
        }
    return hash;
}

bool isFinite()
{
    const float* vertices = scene_vertices();
    for (int k = 0; k < 6 * scene_vertex_count(); ++k)
        if (!std::isfinite(vertices[k])) return false;
    return true;
}

/// Point of the surface [m] with the largest (sign 1) or smallest (sign -1) height.
std::array<double, 3> extreme(double sign)
{
    const float* vertices = scene_vertices();
    const float* most = vertices;
    for (int v = 0; v < scene_vertex_count(); ++v)
        if (sign * double(vertices[6 * v + 1]) > sign * double(most[1])) most = vertices + 6 * v;
    return {most[0], most[1], most[2]};
}
std::array<double, 3> lowest()
{
    return extreme(-1);
}
std::array<double, 3> highest()
{
    return extreme(1);
}

}  // namespace

int main(int argc, char** argv)
{
    std::ifstream file(argc == 2 ? argv[1] : "", std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!scene_open(reinterpret_cast<const unsigned char*>(bytes.data()), int(bytes.size())))
    {
        std::fprintf(stderr, "drag <body.bfem>: %s\n", scene_error());
        return 2;
    }
    std::printf("%d tetrahedra, %.3g kg\n", scene_tets(), scene_mass());
    if (!scene_hold_feet(1)) return 2;
    step(kStand);
    printStepMs("a step, feet held, hit by the ball");
    if (!scene_hold_feet(0)) return 2;
    step(kStand);
    printStepMs("a step, free, on the ground");
    const double standing = scene_centre()[1];
    check("centre, standing [m]", standing, 0.1, 0.7);

    const std::array<double, 3> top = highest();
    check("a ray takes hold of it", scene_pick(top[0], 3, top[2], top[0], -1, top[2]), 1, 1);
    const float* held = scene_held();
    if (!held) return 1;
    const double x = held[0], y = held[1], z = held[2];
    for (int k = 1; k <= kLift; ++k)
    {
        scene_drag(x, y + kHeight * k / kLift, z);
        step(1);
    }
    step(kSettle);
    double sag = 0;  // mean over its oscillation
    for (int k = 0; k < kHold; ++k)
    {
        step(1);
        sag += (y + kHeight - double(scene_held()[1])) / kHold;
    }
    check("sag of the spring / m g / k", sag / (scene_mass() * 9.81 / 6000), 0.9, 1.1);
    check("way of the centre [m]", double(scene_centre()[1]) - standing, 0.5, 1.6);
    check("lowest point while it hangs [m]", lowest()[1], 0.02, 2);
    check("finite", isFinite(), 1, 1);
    printStepMs("a step, lifted");

    scene_release();
    int waited = 0;
    for (; waited < kMax && !scene_asleep(); ++waited) scene_step();
    check("asleep after [steps]", waited, 1, kMax - 1);
    check("centre above the ground [m]", scene_centre()[1], 0.1, standing + 0.05);
    check("finite", isFinite(), 1, 1);
    std::printf("bits %016llx\n", static_cast<unsigned long long>(bits()));
    return failed ? 1 : 0;
}
