// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

#include "bullet_fem/fem/cage/cage_progress.h"

namespace bullet_fem
{

/// How many cubes or elements are looked at between two words on progress.
constexpr int kCellsBetweenProgress = 1024;

/// Throws CageCancelled where the progress gives up.
inline void tell(const CageProgress& progress, double share)
{
    if (progress && !progress(share)) throw CageCancelled();
}

/// Tells how far a loop over `count` cubes or elements is, between two shares.
inline void tellLoop(const CageProgress& progress, std::size_t at, std::size_t count, double from, double to)
{
    if (at % kCellsBetweenProgress == 0) tell(progress, from + (to - from) * double(at) / double(count));
}

/// The progress of a stage, which is the work from one share to another. The whole one must live longer.
inline CageProgress stageOf(const CageProgress& whole, double from, double to)
{
    if (!whole) return {};
    return [&whole, from, to](double share) { return whole(from + (to - from) * share); };
}

}  // namespace bullet_fem
