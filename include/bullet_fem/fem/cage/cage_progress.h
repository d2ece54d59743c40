// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <stdexcept>

#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Called by the thread that makes a cage with the share of the work that is done [-], in [0, 1], which never falls.
/// False gives up.
using CageProgress = std::function<bool(double share)>;

/// What makeCage throws when its progress gives up.
class BULLETFEM_API CageCancelled : public std::runtime_error
{
public:
    /// With the reason that people read.
    CageCancelled() : std::runtime_error("the cage was given up, as its progress asked") {}
};

}  // namespace bullet_fem
