// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// The response of one or two bodies to an impulse between them at a contact patch: their rigid motion, and a few
/// vibrations that represent their elasticity [docs/theory.md, Rebound].
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

    double m_rigid = 0;  ///< mobility of the rigid motion of both [1/kg]
    std::array<Vibration, 2 * kVibrations> m_vibrations;
    int m_count = 0;  ///< number of vibrations
};

/// Adds the elastic response of a body to `impulses` [-], one per node: those on its nodes of a unit impulse on the
/// patch. Call it after solveFreeMotion and before finishStep. Bodies on the low-memory path have none: false.
BULLETFEM_API bool addVibrations(Body& body, const std::vector<Vec3>& impulses, PatchResponse& response);

/// The rigid mobility of a body for such impulses [1/kg]; 0 if fixed nodes hold it.
BULLETFEM_API double rigidMobility(Body& body, const std::vector<Vec3>& impulses);

/// The coefficient of restitution [-], in [0, 1], of two bodies that meet at `speed` [m/s] while the loads accelerate
/// them towards each other by `acceleration` [m/s2]: the separation speed over that of approach, by a simulation of the
/// patch in small steps. 0 if they do not separate.
BULLETFEM_API double elasticRestitution(const PatchResponse& response, double speed, double acceleration);

}  // namespace bullet_fem
