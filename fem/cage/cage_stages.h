// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

#include "bullet_fem/fem/cage/cage_progress.h"

namespace bullet_fem
{

/// Number of cubes or elements between two progress calls.
constexpr int kCellsBetweenProgress = 1024;

/// Reports progress; throws CageCancelled if the callback returns false.
inline void tell(const CageProgress& progress, double share)
{
    if (progress && !progress(share)) throw CageCancelled();
}

/// Reports the progress of a loop over `count` cubes or elements, from one share to another.
inline void tellLoop(const CageProgress& progress, std::size_t at, std::size_t count, double from, double to)
{
    if (at % kCellsBetweenProgress == 0) tell(progress, from + (to - from) * double(at) / double(count));
}

/// The progress callback of a stage that covers the work from one share to another. `whole` must outlive it.
inline CageProgress stageOf(const CageProgress& whole, double from, double to)
{
    if (!whole) return {};
    return [&whole, from, to](double share) { return whole(from + (to - from) * share); };
}

}  // namespace bullet_fem
