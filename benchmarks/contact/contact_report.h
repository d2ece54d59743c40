// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>

#include "benchmarks/contact/contact_run.h"

namespace bullet_fem
{

/// One table a scene, in the order of the rows: times beside errors.
void printTables(std::ostream& out, const std::vector<ContactFigures>& rows);

/// The same figures, one object a row.
nlohmann::json toJson(const std::vector<ContactFigures>& rows);

}  // namespace bullet_fem
