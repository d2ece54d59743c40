// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "fem/body/conjugate_gradients.h"

namespace bullet_fem
{

/// Velocity response of nodes to impulses: A^-1 of the last prepared step, as accurately as contact needs between its
/// corrective solves. P, if the factor is that of A0; on the low-memory path, where P is a poor approximation,
/// conjugate gradients to |r| <= 1e-3 |impulses|. Nodes fixed at present have zero rows. Uses the solver's vectors and
/// the right-hand side in the body's scratch; never allocates.
class WarpedCompliance : public LinearOperator
{
public:
    explicit WarpedCompliance(Body& body, const Threads* threads = nullptr) : m_body(body), m_threads(threads) {}
    void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const override;

private:
    Body& m_body;
    const Threads* m_threads;
};

}  // namespace bullet_fem
