// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace bullet_fem
{

/// What a command tells at its end: a table for people, or --json for programs, with the same names.
class Figures
{
public:
    /// Adds the option --json.
    void addOption(CLI::App& command);

    /// `name` as a JSON member, with the unit behind for people.
    void add(const std::string& name, const nlohmann::json& value, const std::string& unit = "");
    /// A list as a JSON array; people see its length, and these lines below it.
    void addList(const std::string& name, const nlohmann::json& list, const std::vector<std::string>& lines);
    void print() const;
    bool asJson() const { return m_json; }

private:
    struct Row
    {
        std::string m_name, m_unit;
        nlohmann::json m_value;
        std::vector<std::string> m_lines;  // of a list, for people
    };
    bool m_json = false;
    std::vector<Row> m_rows;
};

}  // namespace bullet_fem
