// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/contact/contact_problem.h"

namespace bullet_fem
{

/// The motion of a connected component of a body (TetMesh::nodeComponent) as a rigid proxy with equal momenta, between
/// steps. A component with fixed nodes is immovable.
BULLETFEM_API RigidProxy wholeMotion(const Body& body, int component);

/// Adds a rigid motion, linear [m/s] and angular [rad/s] about a centre [m], to the velocities of a component's nodes,
/// BodyState::m_v.
BULLETFEM_API void addWholeMotion(Body& body, int component, const Vec3& center, const Vec3& linear,
                                  const Vec3& angular);

/// A rebound between two rigid proxies: an impulse at one point on both.
struct Rebound
{
    int m_first = 0;       ///< index into the rigid proxies of the problem
    int m_second = 0;      ///< index into the rigid proxies of the problem
    Vec3 m_point;          ///< point of action of the impulse on both [m]
    Vec3 m_normal;         ///< unit [-], from the second to the first
    double m_speed = 0;    ///< smallest separation speed wanted at the point [m/s]
    double m_impulse = 0;  ///< output: on the first, along the normal [N s], >= 0
};

/// The separation speed of the two at the point, by the velocities of the problem's rigid proxies [m/s].
BULLETFEM_API double separationSpeed(const ContactProblem& problem, const Rebound& rebound);

/// Rebounds that act at once. Impulses conserve the momenta. Keeps scratch only.
class BULLETFEM_API ReboundSystem
{
public:
    /// Reserves memory for a usual number of rebounds; more allocate.
    ReboundSystem();

    /// Sets up rebounds between the rigid proxies of `problem`.
    void set(const ContactProblem& problem, const std::vector<Rebound>& rebounds);

    /// Change of the separation speed of one rebound by a unit impulse of another or of itself [1/kg].
    double compliance(int of, int from) const { return m_compliance[of * m_count + from]; }

    /// Gives the smallest impulses by which all separate with their speed or a larger one to the rigid proxies, in
    /// total with at most `energy` more kinetic energy [J]. True if there are any.
    bool give(ContactProblem& problem, std::vector<Rebound>& rebounds, double energy);

private:
    int m_count = 0;                   // of rebounds
    std::vector<double> m_compliance;  // row by row
    std::vector<double> m_missing;     // scratch
    ContactProblem m_scratch;
};

}  // namespace bullet_fem
