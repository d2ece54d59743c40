// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/machine_info.h"

#include <LinearMath/btScalar.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <thread>

// CMake defines BULLETFEM_VERSION, BULLETFEM_COMMIT and BULLETFEM_BUILD_TYPE.

namespace bullet_fem
{
namespace
{

std::string cpuModel()
{
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
    {
        const std::size_t colon = line.find(": ");
        if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown";
}

std::string compiler()
{
#if defined(__clang__)
    return std::string("Clang ") + __clang_version__;
#elif defined(__GNUC__)
    return std::string("GCC ") + __VERSION__;
#else
    return "unknown";
#endif
}

std::string bulletVersion()
{
    const char* scalar = sizeof(btScalar) == sizeof(float) ? " float" : " double";
    return std::to_string(BT_BULLET_VERSION / 100) + "." + std::to_string(BT_BULLET_VERSION % 100) + scalar;
}

/// Load average of the last minute. Well above 0 before the first measurement it shows that other programs use the
/// machine.
std::string loadAverage()
{
    std::ifstream file("/proc/loadavg");
    std::string load;
    file >> load;
    return load;
}

std::string orUnknown(const std::string& value)
{
    return value.empty() ? "unknown" : value;
}

}  // namespace

MachineInfo readMachineInfo(int threads)
{
    return {{"cpu", cpuModel()},
            {"logical_cores", std::to_string(std::thread::hardware_concurrency())},
            {"load_before", orUnknown(loadAverage())},
            {"threads", std::to_string(threads)},
            {"compiler", compiler()},
            {"build_type", orUnknown(BULLETFEM_BUILD_TYPE)},
            {"bulletfem", BULLETFEM_VERSION},
            {"commit", orUnknown(BULLETFEM_COMMIT)},
            {"bullet", bulletVersion()}};
}

std::string toText(const MachineInfo& info)
{
    std::size_t width = 0;
    for (const auto& field : info) width = std::max(width, field.first.size());
    std::ostringstream text;
    for (const auto& field : info)
        text << field.first << std::string(width - field.first.size() + 2, ' ') << field.second << '\n';
    return text.str();
}

}  // namespace bullet_fem
