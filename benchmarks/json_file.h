// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <fstream>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "benchmarks/machine_info.h"

namespace bullet_fem
{

/// The file that --json names. Opened before the first measurement, so that a wrong path is told at once and not after
/// minutes.
class JsonFile
{
public:
    /// An empty path stands for no file. Throws std::runtime_error if the file cannot be opened.
    explicit JsonFile(const std::string& path);

    /// Writes `document`, an object, with the machine added to it; nothing if there is no file. Throws
    /// std::runtime_error if the file cannot be written.
    void write(const MachineInfo& machine, nlohmann::json document);

private:
    std::string m_path;
    std::ofstream m_file;
};

}  // namespace bullet_fem
