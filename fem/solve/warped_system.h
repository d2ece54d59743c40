// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "fem/body/conjugate_gradients.h"

namespace bullet_fem
{

/// True if a step with these settings works in single precision.
bool isSinglePrecision(const StepSettings& settings);

/// Element rotations, forces and A of the step that begins, in single precision for tolerances of 3e-4 and above and in
/// double below. Turns the state's rotations to the positions y, adds f_el(y) - K' w to `force` [N], with w of
/// `viscous` [m], and leaves in the body's scratch what WarpedSystem works with. Allocates in the first step of double
/// precision, never else.
void prepareWarpedSystem(Body& body, const StepSettings& settings, const std::vector<Vec3>& positions,
                         const std::vector<Vec3>& viscous, std::vector<Vec3>& force);

/// The rotations that WarpedPreconditioner works with, of those of the elements: one a node, or the body's one for all.
void averageNodeRotations(Body& body, const StepSettings& settings);

/// What A multiplies masses and K' with, in the body's scratch: part of prepareWarpedSystem().
void scaleWarpedSystem(Body& body, const StepSettings& settings);

/// To be called before A is used again in the same step, for impulses: makes up for what bodies that are solved side by
/// side leave out where none have followed in their last steps, as that takes them longer than all the products with A.
/// Never allocates.
void completeWarpedSystem(Body& body, const StepSettings& settings);

/// A = (1 + h alpha) M + (c h^2 + h beta) K' + c h^2 T over the free nodes, as last prepared, and what the body's
/// actuators add to it; rows and columns of fixed nodes are zero.
class WarpedSystem : public LinearOperator
{
public:
    explicit WarpedSystem(const Body& body, const Threads* threads = nullptr) : m_body(body), m_threads(threads) {}
    void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const override;

    /// A without actuators, with the rows and columns of fixed nodes: what their motion does to the others.
    void applyUnconstrained(const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

    /// A without its masses, over the free nodes.
    void applyStiffness(const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

    /// c h^2 T alone, of the elements, with the rows and columns of fixed nodes.
    void applyTension(const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

private:
    void multiply(double stiffnessFactor, bool withMass, const std::vector<Vec3>& in, std::vector<Vec3>& out) const;
    void addActuators(const std::vector<Vec3>& in, std::vector<Vec3>& out) const;
    void clearFixed(std::vector<Vec3>& out) const;

    const Body& m_body;
    const Threads* m_threads;
};

/// P = R A0^-1 R^T [Garcia et al. 2006], R block-diagonal with the body's one rotation (global) or one a node (nodal).
/// A node that is fixed now has zero rows; one that was fixed when the factor was built gets the inverse of its
/// diagonal.
class WarpedPreconditioner : public LinearOperator
{
public:
    explicit WarpedPreconditioner(const Body& body, const Threads* threads = nullptr) : m_body(body), m_threads(threads)
    {
    }
    void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const override;

    /// The rotation R_i that the preconditioner gives node i.
    Mat3 rotation(int node) const;

private:
    double rotateIn(const std::vector<Vec3>& in) const;
    void rotateOut(const std::vector<Vec3>& in, double scale, std::vector<Vec3>& out) const;

    const Body& m_body;
    const Threads* m_threads;
};

}  // namespace bullet_fem
