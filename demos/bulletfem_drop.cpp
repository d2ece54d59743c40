// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A surface mesh becomes a finite-element body and falls onto a tilted box and a plane; rigid boxes fall onto it.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>

#include "bullet_fem/io/surface_file.h"
#include "demos/drop_figures.h"
#include "demos/drop_frames.h"
#include "demos/drop_options.h"
#include "demos/drop_report.h"
#include "demos/drop_scene.h"
#include "demos/drop_size.h"
#include "tools/console/program.h"
#include "tools/console/progress_line.h"

namespace
{
using namespace bullet_fem;

constexpr int kCheckFailed = 3;

double stepTimed(DropScene& scene)
{
    const auto start = std::chrono::steady_clock::now();
    scene.step();
    return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void simulate(DropScene& scene, const DropOptions& options, DropFrames& frames, DropFigures& figures)
{
    const int steps = static_cast<int>(std::ceil(options.m_seconds / options.m_step - 1e-6));
    ProgressLine progress;
    frames.write(0);
    for (int k = 1; k <= steps; ++k)
    {
        figures.record(stepTimed(scene));
        const double time = k * options.m_step;
        if (time * options.m_framesPerSecond + 1e-6 >= frames.frameCount()) frames.write(time);

        char text[80];
        std::snprintf(text, sizeof text, "%.2f s, %d contacts, %.2f ms a step", time, scene.report().m_contacts,
                      figures.m_stepMs.mean());
        progress.show(double(k) / steps, text);
    }
    progress.finish();
}

DropSize sizeOf(const DropOptions& options)
{
    const DropSize size = chooseSize(readSurfaceFile(options.m_meshFile), options);
    std::printf("%s: longest side %.4g, times %.4g = %.4g m\n", options.m_meshFile.c_str(), size.m_fileLength,
                size.m_scale, size.m_length);
    std::fflush(stdout);  // keeps stdout and stderr in order
    return size;
}

/// Returns false if a check of the report failed.
bool run(const DropOptions& options)
{
    DropScene scene(options, sizeOf(options));
    DropFrames frames(options.m_outputFolder, scene);
    DropFigures figures(scene);
    simulate(scene, options, frames, figures);
    std::printf("%d frames in %s and %s\n", frames.frameCount(), frames.bodyPath().c_str(), frames.rigidPath().c_str());
    return printReport(scene, figures);
}

}  // namespace

int main(int argc, char** argv)
{
    DropOptions options;
    if (const auto exitCode = parseOptions(argc, argv, options)) return *exitCode;
    return runProgram("bulletfem_drop", [&] { return run(options) ? 0 : kCheckFailed; });
}
