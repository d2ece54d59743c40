// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "fem/body/conjugate_gradients.h"

namespace bullet_fem
{

/// Velocity response of nodes to impulses in the last prepared step, as accurately as contact needs between its
/// corrective solves: the rigid response, exactly, plus an elastic one times a scale, learnt in contact. The elastic
/// one is P_e, if the factor is that of A0; on the low-memory path, where P_e is a poor approximation, conjugate
/// gradients to |r| <= 1e-3 |impulses|. Nodes fixed at present have zero rows. Uses the solver's vectors and the
/// right-hand side in the body's scratch; never allocates.
class WarpedCompliance : public LinearOperator
{
public:
    WarpedCompliance(Body& body, double scale, const Threads* threads = nullptr)
        : m_body(body), m_scale(scale), m_threads(threads)
    {
    }
    void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const override;

    /// Without the rigid response.
    void applyElastic(const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

    /// The elastic response of A itself, without the scale, by conjugate gradients to |r| <= 1e-4 |impulses|. A must be
    /// complete, see completeWarpedSystem().
    void applyPresent(const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

private:
    std::vector<Vec3>& rightSide(const std::vector<Vec3>& in) const;
    void solve(double tolerance, const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

    Body& m_body;
    double m_scale;  // of the elastic response [-]
    const Threads* m_threads;
};

}  // namespace bullet_fem
