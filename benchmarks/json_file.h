// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <fstream>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "benchmarks/machine_info.h"

namespace bullet_fem
{

/// The file named by --json. It is opened before the first measurement, so that a wrong path is reported at once.
class JsonFile
{
public:
    /// An empty path stands for no file. Throws std::runtime_error if the file cannot be opened.
    explicit JsonFile(const std::string& path);

    /// Writes `document`, an object, and adds the machine's data; does nothing without a file. Throws
    /// std::runtime_error if the file cannot be written.
    void write(const MachineInfo& machine, nlohmann::json document);

private:
    std::string m_path;
    std::ofstream m_file;
};

}  // namespace bullet_fem
