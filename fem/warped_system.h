// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body.h"
#include "fem/conjugate_gradients.h"

namespace bullet_fem
{

/// A = (1 + h alpha) M + (h^2 + h beta) K' + h^2 T over the free nodes; rows and columns of fixed nodes are zero.
class WarpedSystem : public LinearOperator
{
public:
    WarpedSystem(const Body& body, double step) : m_body(body), m_step(step) {}
    void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const override;

    /// A with the rows and columns of fixed nodes: what their motion does to the others.
    void applyUnconstrained(const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

private:
    const Body& m_body;
    double m_step;
};

/// P = R A0^-1 R^T [Garcia et al. 2006], R block-diagonal with the body's one rotation (global) or one a node (nodal).
/// A node that is fixed now has zero rows; one that was fixed when the factor was built gets the inverse of its
/// diagonal.
class WarpedPreconditioner : public LinearOperator
{
public:
    WarpedPreconditioner(const Body& body, Warp warp) : m_body(body), m_warp(warp) {}
    void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const override;

    /// The rotation R_i that the preconditioner gives node i.
    const Mat3& rotation(int node) const
    {
        return m_warp == Warp::nodal ? m_body.m_state.m_nodeRotation[node] : m_body.m_state.m_bodyRotation;
    }

private:
    const Body& m_body;
    Warp m_warp;
};

/// R_i = polar(sum over the elements at i of V_e R_e) and the body's Q = polar(sum over all V_e R_e), warm-started.
void updateWarpRotations(Body& body);

}  // namespace bullet_fem
