// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "BulletSoftBody/btDeformableBodySolver.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/common/export.h"

/// Makes tetrahedral bodies of a btDeformableMultiBodyDynamicsWorld finite-element bodies: give it to the world's
/// constructor, and to setDeformableSolver of its btDeformableMultiBodyConstraintSolver, in place of
/// btDeformableBodySolver. All other bodies, such as cloth, keep Bullet's own solver.
///
/// A body becomes FEM when it has tetrahedra and a material: from the btDeformableLinearElasticityForce,
/// btDeformableCorotatedForce or btDeformableNeoHookeanForce that the world has for it, or by fem().setMaterial().
/// Lame's constants mu and lambda become E = mu (3 lambda + 2 mu) / (lambda + mu) and nu = lambda / (2 (lambda + mu)),
/// clamped to [0, .499]. The conversion serves a Neo-Hookean force, too, whose setYoungsModulus() uses its inverse,
/// although Bullet's formula is softer at small strain (3/4 of its mu and lambda - 5/8 mu) and stiffer in compression;
/// its bodies have btFemElasticLaw::neoHooke, all others Hooke's law. Damping of linear elasticity is Rayleigh damping,
/// damping of a Neo-Hookean force is stiffness damping. A change of the forces' values takes effect at the next step
/// and replaces a material from setMaterial(). The body keeps its masses.
///
/// A tetrahedral body without a material stays with Bullet's solver. If it lacks the links and scratch arrays that
/// Bullet's solver needs (as bodies of btFemHelpers do), it becomes FEM with E = 1e6 kLST Pa, nu .3. A body that cannot
/// become FEM stays with Bullet's solver, or stands still; rejection() and its report give the reason.
///
/// Gravity acts as in Bullet: only if the world has a btDeformableGravityForce for the body, times its m_gravityFactor.
/// Mouse picking becomes springs of its stiffness on the three nodes (as by addSpring(), with negative handles in
/// anchors()); its maximum force limits the impulse of a step [N s], as in Bullet. Its damping, and forces of user
/// classes, are evaluated at the beginning of the step and divided by 1 + (h d + h^2 k) / m of their node, with their
/// stiffness k and damping d, so that none is too stiff for the step. Springs along links (btDeformableMassSpringForce)
/// and settings of Bullet's own solver (implicit, line search, projection) have no effect on FEM bodies. Wind,
/// pressure, volume conservation and pose matching act on them as in other worlds; m_cfg.drag, not kDP, damps them, as
/// it does Bullet's bodies.
///
/// FEM bodies collide with rigid bodies, links of multibodies and each other (flags VF_DD, VF_SS or CL_SS in common),
/// after the rigid bodies have moved, as in btSoftRigidDynamicsWorld. They collide with cloth if both have VF_DD.
///
/// Lifetime: must outlive its world, and serves one world. From the start of a step until the FEM bodies move, at its
/// end, they are absent from the lists of the world's forces. Threads and allocation: as in btFemSoftBodySolver, and as
/// in Bullet for other bodies.
class BULLETFEM_API btFemDeformableBodySolver : public btDeformableBodySolver
{
public:
    /// Throws std::invalid_argument if !info.valid().
    explicit btFemDeformableBodySolver(const btFemSolverInfo& info = btFemSolverInfo());
    ~btFemDeformableBodySolver() override;
    btFemDeformableBodySolver(const btFemDeformableBodySolver&) = delete;
    btFemDeformableBodySolver& operator=(const btFemDeformableBodySolver&) = delete;

    /// The solver of the FEM bodies, with their materials, reports and contacts. Its optimize, predictMotion,
    /// solveConstraints and updateSoftBodies are reserved for this class.
    btFemSoftBodySolver& fem();
    /// The solver of the FEM bodies, read-only.
    const btFemSoftBodySolver& fem() const;

    /// Reason why a tetrahedral body with a material was left to Bullet's solver in the last step; empty if it was not.
    /// Valid until the next step.
    const char* rejection(const btSoftBody* body) const;

    /// @name Called by the world
    /// @{

    /// Overrides of Bullet's stages: FEM bodies are stepped by fem(), all other bodies by the base class.
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
