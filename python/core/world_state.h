// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

#include "python/core/world.h"

namespace bullet_fem::python
{

/// The state of a world as bytes: its number of steps, and what btFemWorldState saves.
struct WorldState
{
    static void save(World& world, std::vector<unsigned char>& bytes);
    /// Prepares new bodies. Throws std::invalid_argument, without another change, as btFemWorldState does.
    static void restore(World& world, const unsigned char* data, std::size_t size);
};

}  // namespace bullet_fem::python
