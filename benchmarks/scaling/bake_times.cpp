// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/scaling/bake_times.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "benchmarks/figures.h"
#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

constexpr int kRuns = 9;

template <class Work>
double medianSeconds(const Work& work)
{
    std::vector<double> seconds;
    for (int k = 0; k < kRuns; ++k)
    {
        const Stopwatch watch;
        work();
        seconds.push_back(watch.seconds());
    }
    return median(seconds);
}

std::vector<Vec3> placesAfterSteps(const std::shared_ptr<const BodyModel>& model)
{
    Body body(model);
    for (int i = 0; i < model->nodeCount(); ++i) body.m_loads.m_force[i] = {0, 0, -9.81 * body.m_state.m_mass[i]};
    for (int k = 0; k < 10; ++k) step(body, StepSettings());
    return body.m_state.m_x;
}

bool sameBits(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    bool same = a.size() == b.size();
    for (std::size_t i = 0; same && i < a.size(); ++i) same = a[i].x == b[i].x && a[i].y == b[i].y && a[i].z == b[i].z;
    return same;
}

}  // namespace

BakeTimes measureBake(const BeamCase& beam)
{
    BakeSettings settings;
    settings.m_material = beam.m_material;
    settings.m_step = beam.m_step;
    settings.m_pins = beam.m_clampedNodes;
    settings.m_singlePrecision = false;
    BakedBody baked;
    BakeTimes times;
    times.m_tets = static_cast<int>(beam.m_tets.size());
    times.m_setupSeconds = medianSeconds([&] { baked = bakeBody(TetMesh(beam.m_positions, beam.m_tets), settings); });
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "bulletfem_bench_scaling.bfem";
    times.m_writeSeconds = medianSeconds([&] { writeBakedBody(path.string(), baked); });
    times.m_fileMegabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(path));
    BakedBody read;
    times.m_mappedSeconds = medianSeconds([&] { read = readBakedBody(path.string()); });
    times.m_copiedSeconds = medianSeconds([&] { read = readBakedBody(path.string(), BakedLoading::copied); });
    times.m_sameMotion = sameBits(placesAfterSteps(read.m_model), placesAfterSteps(baked.m_model));
    std::filesystem::remove(path);
    return times;
}

void printTable(std::ostream& out, const std::vector<BakeTimes>& rows)
{
    print(out, "%7s  %8s %9s %9s  %9s %6s  %9s %6s  %s\n", "tets", "setup ms", "file MB", "write ms", "mapped ms",
          "faster", "copied ms", "faster", "motion");
    for (const BakeTimes& row : rows)
        print(out, "%7d  %8.2f %9.2f %9.2f  %9.3f %5.0fx  %9.3f %5.0fx  %s\n", row.m_tets, 1e3 * row.m_setupSeconds,
              row.m_fileMegabytes, 1e3 * row.m_writeSeconds, 1e3 * row.m_mappedSeconds,
              row.m_setupSeconds / row.m_mappedSeconds, 1e3 * row.m_copiedSeconds,
              row.m_setupSeconds / row.m_copiedSeconds, row.m_sameMotion ? "same bits" : "DIFFERENT");
}

nlohmann::json toJson(const std::vector<BakeTimes>& rows)
{
    nlohmann::json list = nlohmann::json::array();
    for (const BakeTimes& row : rows)
        list.push_back({{"tets", row.m_tets},
                        {"setup_s", row.m_setupSeconds},
                        {"file_mb", row.m_fileMegabytes},
                        {"write_s", row.m_writeSeconds},
                        {"mapped_s", row.m_mappedSeconds},
                        {"copied_s", row.m_copiedSeconds},
                        {"same_bits", row.m_sameMotion}});
    return list;
}

}  // namespace bullet_fem
