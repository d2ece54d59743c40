// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>

#include "benchmarks/contact/contact_run.h"

namespace bullet_fem
{

/// Prints one table per scene, in the order of the rows.
void printTables(std::ostream& out, const std::vector<ContactFigures>& rows);

/// The results as JSON, one object per row.
nlohmann::json toJson(const std::vector<ContactFigures>& rows);

}  // namespace bullet_fem
