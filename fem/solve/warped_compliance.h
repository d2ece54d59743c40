// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "fem/body/conjugate_gradients.h"

namespace bullet_fem
{

/// What impulses on nodes do to their velocities, A^-1 of the step that was last prepared, as closely as contact asks
/// between its corrective solves: P where the factor is that of A0; on the low-memory path, where P is far from it,
/// conjugate gradients to |r| <= 1e-3 |impulses|. A node that is fixed now has zero rows. Uses the solver's vectors in
/// the body's scratch and its right-hand side; never allocates.
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
