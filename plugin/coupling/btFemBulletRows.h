// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h"
#include "bullet_bridge/rigid/bullet_rows.h"

/// The rows of Bullet's constraint solvers: those between rigid bodies, then those of links. A view.
struct btFemBulletRows
{
    bullet_fem::BulletConstraints m_constraints;  ///< of rigid bodies
    btMultiBodyJacobianData& m_linkData;
    std::array<btMultiBodyConstraintArray*, 5> m_links;

    /// Writes the impulses of all rows [N s] to `noted`. Allocates when there are more than ever.
    void note(std::vector<btScalar>& noted) const;

    /// Gives the rows impulses of note(), and changes the velocities of solver bodies and multibodies accordingly.
    void restoreBest(const std::vector<btScalar>& noted) const;

private:
    void change(btSolverConstraint& row, btScalar impulse) const;
    void change(btMultiBodySolverConstraint& row, btScalar impulse) const;
    void changeBody(int body, const btVector3& linear, const btVector3& angular, btScalar impulse) const;
    void changeLinks(btMultiBody& body, int jacobian, int first, btScalar impulse) const;
    template <class Visit>
    void forEach(const Visit& visit) const;
};
