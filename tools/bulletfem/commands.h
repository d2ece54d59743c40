// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <CLI/CLI.hpp>

namespace bullet_fem
{

/// Each adds a subcommand, which is run when the command line has been parsed. What it throws is an error of the data:
/// std::exception with a message for the user.
void addCageCommand(CLI::App& app);
void addBakeCommand(CLI::App& app);
void addInfoCommand(CLI::App& app);
void addConvertCommand(CLI::App& app);
void addSimulateCommand(CLI::App& app);

}  // namespace bullet_fem
