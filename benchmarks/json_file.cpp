// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/json_file.h"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace bullet_fem
{

JsonFile::JsonFile(const std::string& path) : m_path(path)
{
    if (path.empty()) return;
    m_file.open(path);
    if (!m_file) throw std::runtime_error("cannot open " + path + " for writing: choose another --json");
}

void JsonFile::write(const MachineInfo& machine, nlohmann::json document)
{
    if (m_path.empty()) return;
    for (const auto& field : machine) document["machine"][field.first] = field.second;
    m_file << document.dump(2) << '\n';
    if (!m_file.flush()) throw std::runtime_error("cannot write to " + m_path);
}

}  // namespace bullet_fem
