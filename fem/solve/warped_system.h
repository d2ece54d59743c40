// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "fem/body/conjugate_gradients.h"

namespace bullet_fem
{

/// True if a step with these settings works in single precision.
bool isSinglePrecision(const StepSettings& settings);

/// Assembles the element rotations, forces and A of the step that begins, in single precision for tolerances of 3e-4
/// and above and in double below. Updates the state's rotations to the positions y [m], adds f_el(y) - K' w to `force`
/// [N], with w = `viscous` [m], and prepares the scratch for WarpedSystem. Allocates in the first step of double
/// precision only.
void prepareWarpedSystem(Body& body, const StepSettings& settings, const std::vector<Vec3>& positions,
                         const std::vector<Vec3>& viscous, std::vector<Vec3>& force);

/// Computes the rotations of WarpedPreconditioner from those of the elements: one per node, or one for the body.
void averageNodeRotations(Body& body, const StepSettings& settings);

/// Computes the factors of masses and K' in A, in the body's scratch: part of prepareWarpedSystem().
void scaleWarpedSystem(Body& body, const StepSettings& settings);

/// Completes A for impulse responses of a step; call it before A is used again. Side-by-side solves skip A in bodies
/// without impulses in their last steps, because storing it takes longer than all products with A. Never allocates.
void completeWarpedSystem(Body& body, const StepSettings& settings);

/// Pi^T A for elastic velocities, Pi^T of RigidMomentum and A = (1 + h alpha) M + (c h^2 + h beta) K' + c h^2 T over
/// the free nodes, as last prepared, plus the contribution of the body's actuators; rows and columns of fixed nodes are
/// zero.
class WarpedSystem : public LinearOperator
{
public:
    explicit WarpedSystem(const Body& body, const Threads* threads = nullptr) : m_body(body), m_threads(threads) {}
    void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const override;

    /// A without actuators, including rows and columns of fixed nodes, to eliminate their prescribed motion.
    void applyUnconstrained(const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

    /// A - M over the free nodes, with actuators.
    void applyStiffness(const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

    /// c h^2 T of the elements alone, including rows and columns of fixed nodes.
    void applyTension(const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

private:
    void multiply(double stiffnessFactor, bool withMass, const std::vector<Vec3>& in, std::vector<Vec3>& out) const;
    void addActuators(const std::vector<Vec3>& in, std::vector<Vec3>& out) const;
    void clearFixed(std::vector<Vec3>& out) const;

    const Body& m_body;
    const Threads* m_threads;
};

/// P_e = Pi R (A0^-1 - r r^T (1 / s - 1 / lambda_1)) R^T Pi^T, the rotated factor [Garcia et al. 2006] without rigid
/// motions: without the rest modes r (RestModes), if these can move at present, and without the present ones by Pi of
/// RigidMomentum. The term of 1 / lambda_1 keeps it definite where rotations average out, as in a bar bent to a ring. R
/// is block-diagonal with one rotation for the body (global) or one per node (nodal). Nodes fixed at present have zero
/// rows; nodes fixed only when the factor was built get the inverse of their diagonal.
class WarpedPreconditioner : public LinearOperator
{
public:
    explicit WarpedPreconditioner(const Body& body, const Threads* threads = nullptr) : m_body(body), m_threads(threads)
    {
    }
    void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const override;

    /// The rotation R_i of the preconditioner at a node.
    Mat3 rotation(int node) const;

private:
    double rotateIn(const std::vector<Vec3>& in) const;
    void rotateOut(const std::vector<Vec3>& in, double scale, std::vector<Vec3>& out) const;

    const Body& m_body;
    const Threads* m_threads;
};

}  // namespace bullet_fem
