// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/bulletfem/figures.h"

#include <algorithm>
#include <iomanip>
#include <iostream>

namespace bullet_fem
{

void Figures::addOption(CLI::App& command)
{
    command.add_flag("--json", m_json, "print the results as JSON");
}

void Figures::add(const std::string& name, const nlohmann::json& value, const std::string& unit)
{
    m_rows.push_back({name, unit, value, {}});
}

void Figures::addList(const std::string& name, const nlohmann::json& list, const std::vector<std::string>& lines)
{
    m_rows.push_back({name, "", list, lines});
}

void Figures::print() const
{
    if (m_json)
    {
        nlohmann::ordered_json all;
        for (const Row& row : m_rows) all[row.m_name] = row.m_value;
        std::cout << all.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
        return;
    }
    std::size_t width = 0;
    for (const Row& row : m_rows) width = std::max(width, row.m_name.size());
    for (const Row& row : m_rows)
    {
        std::cout << std::left << std::setw(static_cast<int>(width) + 2) << row.m_name;
        if (row.m_value.is_number_float())
            std::cout << std::setprecision(6) << row.m_value.get<double>();
        else if (row.m_value.is_string())
            std::cout << row.m_value.get_ref<const std::string&>();
        else if (row.m_lines.empty())
            std::cout << row.m_value.dump();
        else
            std::cout << row.m_value.size();
        std::cout << (row.m_unit.empty() ? "" : " ") << row.m_unit << '\n';
        for (const std::string& line : row.m_lines) std::cout << "  " << line << '\n';
    }
}

}  // namespace bullet_fem
