// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_fem/fem/contact/contact_solver.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{

/// A soft cube of 1 m and 1000 kg, its lowest corner at the origin, above one rigid proxy: a static half space by
/// default. Sweeps, outer iterations and tolerances are set for a converged solution of the contact law.
struct ContactScene
{
    /// young: E [Pa]; turn: rotates body, contacts and velocities set through the scene about the origin.
    explicit ContactScene(double young = 1e6, const Mat3& turn = Mat3::identity());

    /// A contact for each of the 9 nodes of the lower face, with the rigid proxy's surface `gap` [m] below.
    void touchLowerFace(double gap, double friction);

    /// A contact at one node.
    void touchNode(int node, double gap, double friction);

    /// Velocities of the whole cube [m/s], in the unturned frame.
    void setVelocity(const Vec3& v);

    /// Computes the free motion, then solves the contacts.
    ContactReport solve();

    /// Relative velocity of soft against rigid at a contact, during the step [m/s].
    Vec3 relativeVelocity(const ContactPoint& contact) const;

    double softMass() const;
    Vec3 totalImpulse() const;

    Mat3 m_turn;
    Body m_body;
    std::shared_ptr<ComplianceCache> m_cache;
    ContactProblem m_problem;
    std::vector<RigidProxy>& m_rigidProxies = m_problem.m_rigidProxies;
    std::vector<ContactPoint>& m_contacts = m_problem.m_contacts;
    ContactSettings m_settings;
    ContactSolver m_solver;
};

/// Gives the rigid proxy the mass properties of a solid ball [kg, m].
void makeBall(RigidProxy& rigidProxy, double mass, double radius);

}  // namespace bullet_fem
