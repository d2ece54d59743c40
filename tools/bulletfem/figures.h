// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace bullet_fem
{

/// Final results of a command, printed as a table or, with --json, as JSON with these names.
class Figures
{
public:
    /// Adds the option --json.
    void addOption(CLI::App& command);

    /// Adds a value: a JSON member called `name`; the table appends the unit.
    void add(const std::string& name, const nlohmann::json& value, const std::string& unit = "");
    /// Adds a list: a JSON array; the table shows its length and then these lines.
    void addList(const std::string& name, const nlohmann::json& list, const std::vector<std::string>& lines);
    void print() const;
    bool asJson() const { return m_json; }

private:
    struct Row
    {
        std::string m_name, m_unit;
        nlohmann::json m_value;
        std::vector<std::string> m_lines;  // of a list, for the table
    };
    bool m_json = false;
    std::vector<Row> m_rows;
};

}  // namespace bullet_fem
