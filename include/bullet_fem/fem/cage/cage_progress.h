// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <stdexcept>

#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Progress callback of makeCage: receives the completed share of the work [-], in [0, 1] and nondecreasing, on the
/// calling thread. Returns false to cancel.
using CageProgress = std::function<bool(double share)>;

/// Exception of makeCage after its progress callback returned false.
class BULLETFEM_API CageCancelled : public std::runtime_error
{
public:
    /// Sets a readable reason.
    CageCancelled() : std::runtime_error("the cage was given up, as its progress asked") {}
};

}  // namespace bullet_fem
