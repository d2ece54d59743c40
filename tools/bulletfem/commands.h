// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <CLI/CLI.hpp>

namespace bullet_fem
{

/// Each function adds a subcommand, which runs when the command line has been parsed. A subcommand throws
/// std::exception with a message for the user on invalid data.
void addCageCommand(CLI::App& app);
void addBakeCommand(CLI::App& app);
void addInfoCommand(CLI::App& app);
void addConvertCommand(CLI::App& app);
void addSimulateCommand(CLI::App& app);

}  // namespace bullet_fem
