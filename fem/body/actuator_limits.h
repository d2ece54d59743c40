// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

/// Maximum gauge pressure of a chamber [Pa]: 1000 bar, above the pressures of hydraulics. The pressure of a sealed gas
/// is capped here, so that forces stay finite while a chamber is crushed flat.
constexpr double kMaxPressure = 1e8;

/// Maximum activation of fibres [Pa], equal to that of any initial stress.
constexpr double kMaxActivation = 1e13;

}  // namespace bullet_fem
