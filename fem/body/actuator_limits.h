// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

/// The highest pressure of a chamber [Pa]: a thousand bar, beyond what hydraulics use; a sealed gas of less volume than
/// that gives it has this one, so that forces stay finite while a chamber is crushed flat.
constexpr double kMostPressure = 1e8;

/// The strongest activation of fibres [Pa], as any initial stress.
constexpr double kMostActivation = 1e13;

}  // namespace bullet_fem
