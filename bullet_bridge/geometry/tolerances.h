// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

/// Tolerances that several searches for contacts share (docs/contact.md, Tolerances). Others are where they are used.
namespace bullet_fem
{

constexpr double kContactBand = 0.05;       ///< gap below which points are in contact, over the mean edge [-]
constexpr double kNegligibleLength = 1e-3;  ///< lengths that count as zero on faces, rims and edges, over an edge [-]
constexpr double kSoftSlop = 5e-4;          ///< permitted penetration between deformable bodies, over their size [-]

constexpr double kFlatCosine = 0.99;       ///< smallest cosine of normals of one flat surface [-]
constexpr double kSameNormalCosine = 0.9;  ///< smallest cosine of normals of one contact, from step to step, too [-]
constexpr double kCarrierCosine = 0.7;     ///< smallest cosine of normals of surfaces that carry together [-]
constexpr double kFacingCosine = -0.1;     ///< largest cosine of normals that oppose each other [-]

constexpr double kRidgeSine = 0.03;  ///< sine of the dihedral angle from which an edge is a ridge or groove [-]

}  // namespace bullet_fem
