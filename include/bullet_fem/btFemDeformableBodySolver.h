// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "BulletSoftBody/btDeformableBodySolver.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/common/export.h"

/// Makes tetrahedral bodies of a btDeformableMultiBodyDynamicsWorld finite-element bodies: give it to the world's
/// constructor, and to setDeformableSolver of its btDeformableMultiBodyConstraintSolver, in place of
/// btDeformableBodySolver. All others, such as cloth, keep Bullet's own solver.
///
/// A body becomes FEM when it has tetrahedra and a material: from the btDeformableLinearElasticityForce,
/// btDeformableCorotatedForce or btDeformableNeoHookeanForce that the world has for it, or by fem().setMaterial().
/// Lame's coefficients mu and lambda become E = mu (3 lambda + 2 mu) / (lambda + mu) and nu = lambda / (2 (lambda +
/// mu)), at most .499 and at least 0; of a Neo-Hookean force, too, whose setYoungsModulus() means just that, though
/// Bullet's formula is softer at small strain (3/4 of its mu and lambda - 5/8 mu) and stiffer when it is pressed.
/// Its bodies have btFemElasticLaw::neoHooke, all others Hooke's law.
/// Linear elasticity's damping is Rayleigh's, Neo-Hookean damping is stiffness damping. A change of the forces' values
/// is obeyed at the next step. What setMaterial() gave is kept until then. Masses stay the body's.
///
/// A tetrahedral body without a material stays with Bullet's solver, or, if it lacks the links and scratch arrays that
/// Bullet's solver needs (bodies of btFemHelpers do), is FEM with E = 1e6 kLST Pa, nu .3. One that cannot become FEM
/// stays with Bullet's, or stands still; rejection() and its report say why.
///
/// Of other forces on FEM bodies, gravity acts as Bullet's does: only where the world has a btDeformableGravityForce
/// for the body, times its m_gravityFactor. Mouse picking becomes springs of its stiffness on the three nodes (as
/// addSpring() makes them, with negative handles in anchors()); its largest force is one of the impulse in a step [N
/// s], as in Bullet. Its damping, and forces of the user's own, are taken at the step's beginning, divided by 1 + (h d
/// + h^2 k) / m of their node, with their stiffness k and damping d, so that none is too stiff for the step. Springs
/// along links (btDeformableMassSpringForce) and Bullet's settings of its own solver (implicit, line search,
/// projection) mean nothing to FEM bodies. Wind, pressure, volume conservation and poses act on them as in other
/// worlds; m_cfg.drag, not kDP, damps them, as it does Bullet's.
///
/// FEM bodies touch rigid bodies, links of multibodies and each other (flags VF_DD, VF_SS or CL_SS in common), after
/// the rigid bodies have moved, as in btSoftRigidDynamicsWorld. They touch cloth where both have VF_DD.
///
/// Lifetime: outlives its world, and serves one. From the start of a step until the FEM bodies move, at its end, they
/// are absent from the lists of the world's forces. Threads and allocation: as btFemSoftBodySolver, and Bullet's own.
class BULLETFEM_API btFemDeformableBodySolver : public btDeformableBodySolver
{
public:
    /// Throws std::invalid_argument if !info.valid().
    explicit btFemDeformableBodySolver(const btFemSolverInfo& info = btFemSolverInfo());
    ~btFemDeformableBodySolver() override;
    btFemDeformableBodySolver(const btFemDeformableBodySolver&) = delete;
    btFemDeformableBodySolver& operator=(const btFemDeformableBodySolver&) = delete;

    /// Moves the FEM bodies: their materials, reports, contacts. Its optimize, predictMotion, solveConstraints and
    /// updateSoftBodies are for this class alone.
    btFemSoftBodySolver& fem();
    /// The same, to read.
    const btFemSoftBodySolver& fem() const;

    /// Why a tetrahedral body with a material was left to Bullet in the last step; empty if it was not. Valid until the
    /// next step.
    const char* rejection(const btSoftBody* body) const;

    /// @name Called by the world
    /// @{

    /// Each does with FEM bodies what it does in Bullet with others, and hands these to Bullet's own.
    void reinitialize(const btAlignedObjectArray<btSoftBody*>& softBodies, btScalar dt) override;
    void predictMotion(btScalar solverdt) override;
    void processCollision(btSoftBody* body, const btCollisionObjectWrapper* other) override;
    void processCollision(btSoftBody* body, btSoftBody* other) override;
    void setConstraints(const btContactSolverInfo& info) override;
    void solveDeformableConstraints(btScalar solverdt) override;
    void applyTransforms(btScalar timeStep) override;
    void setGravity(const btVector3& gravity) override;
    btAlignedObjectArray<btDeformableLagrangianForce*>* getLagrangianForceArray() override;
    /// @}

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};
