// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// The elastic response of one or two bodies to an impulse between them at a contact patch: a few vibrations that
/// represent it [docs/theory.md, Rebound].
struct PatchResponse
{
    /// A vibration: its displacement z of the patch obeys z'' + beta w^2 z' + w^2 z = m_mobility F.
    struct Vibration
    {
        double m_mobility = 0;   ///< [1/kg]
        double m_frequency = 0;  ///< squared angular frequency w^2 [1/s2]
        double m_damping = 0;    ///< stiffness damping beta [s]
    };

    static constexpr int kVibrations = 8;  ///< of one body

    std::array<Vibration, 2 * kVibrations> m_vibrations;
    int m_count = 0;  ///< number of vibrations
};

/// Adds the elastic response of a body to `impulses` [-], one per node: those on its nodes of a unit impulse on the
/// patch. Call it after solveFreeMotion and before finishStep. Bodies on the low-memory path have none: false.
BULLETFEM_API bool addVibrations(Body& body, const std::vector<Vec3>& impulses, PatchResponse& response);

/// Contact patches of bodies that meet at once, 1 to kMaxCount. One entry per patch in every list but m_compliance.
struct MeetingPatches
{
    static constexpr std::size_t kMaxCount = 16;  ///< of patches

    std::vector<PatchResponse> m_responses;  ///< of the two bodies at a patch
    /// Change of the separation speed of one patch by a unit impulse of another or of itself on the rigid motions
    /// [1/kg], row by row: the number of patches squared.
    std::vector<double> m_compliance;
    std::vector<double> m_speed;         ///< at which the two sides meet [m/s]
    std::vector<double> m_acceleration;  ///< towards each other, by the loads [m/s2]
};

/// Finds the separation speeds [m/s] with which the rigid motions of all part in the end, by a simulation of the
/// patches in small steps. False if none part, as where loads hold them together. Throws std::invalid_argument, naming
/// the number, if there are more than kMaxCount patches, or a list has another size than theirs.
BULLETFEM_API bool findPartingSpeeds(const MeetingPatches& patches, std::vector<double>& parting);

}  // namespace bullet_fem
