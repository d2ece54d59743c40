// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_bridge/rigid/articulated_history.h"
#include "bullet_bridge/rigid/multibody_dynamics.h"
#include "bullet_bridge/rigid/rigid_objects.h"
#include "bullet_fem/fem/contact/contact_solver.h"

namespace bullet_fem
{

/// Bullet's multibodies with links that are in contact with soft bodies or held by them, or with rows of Bullet's that
/// are solved with soft bodies. In joint coordinates q an
/// impulse f and an angular impulse t on link a change the velocities by
///     dq' = M^-1 J_a^T (t, f)        and link b moves by J_b dq'
/// with M from Bullet's articulated body algorithm at the present pose. An impulse on one link thus moves all links of
/// its multibody [Featherstone 2008, chapters 7, 11].
class ArticulatedBodies
{
public:
    /// Forgets velocities noted before the rigid solver, and the memory of multibodies that felt no impulse in the last
    /// step.
    void beginStep() { m_history.beginStep(); }

    /// Call for Bullet's deformable world. It adds forces and gravity to velocities before noteBeforeSolve(), and then
    /// subtracts the world's `gravity` [m/s2] from the forces.
    void assumeForcesGiven(const Vec3& gravity)
    {
        m_history.assumeForcesGiven();
        m_dynamics.setTakenGravity(gravity);
    }

    /// Notes the velocity of a multibody before Bullet's rigid solver. Not thread-safe.
    void noteBeforeSolve(const btMultiBody& body) { m_history.noteBeforeSolve(body); }

    /// Forgets all links.
    void clear();

    /// Makes rigid proxy `index` that of a movable link, and returns the link's present velocity. The proxy's velocity
    /// is the predicted one without soft bodies: forces, gravity and Coriolis terms act for `step` [s], and contacts,
    /// motors and limits support each joint as in this step, as far as they balance the forces and the last impulses of
    /// soft bodies. If `step` is 0 it is the present one, which contains all forces within Bullet's rigid solver. The
    /// order of calls is that of the responses.
    LinkMotion add(int index, const btMultiBodyLinkCollider& link, double step, RigidProxy& rigidProxy);

    /// Moves the reference point of velocities and impulses of rigid proxy `index` to `center` [m]; it moves with the
    /// link.
    void setCenter(int index, const Vec3& center);

    /// Adds a proxy `index` whose velocity is J q' in three rows; `answers` are the rows of J M^-1. Null rows are 0. An
    /// impulse on it along axis k acts by row k.
    void addRows(int index, btMultiBody& body, const std::array<const btScalar*, 3>& jacobians,
                 const std::array<const btScalar*, 3>& answers, RigidProxy& rigidProxy);

    /// Adds a proxy `index` whose motion is that of link `a` at its `point` [m] less that of link `b` of the same
    /// multibody at the proxy's centre.
    void addBetween(int index, const btMultiBodyLinkCollider& a, const Vec3& point, const btMultiBodyLinkCollider& b,
                    RigidProxy& rigidProxy);

    /// Lets go of the rigid proxies from `first` on: apply() takes their position corrections from `rigidProxies` as
    /// they are now.
    void letGo(int first, const std::vector<RigidProxy>& rigidProxies);

    /// Writes the links' responses to impulses. Call after all links are added, and again after more are added.
    void connect(std::vector<RigidProxy>& rigidProxies, std::vector<RigidResponse>& responses) const;

    bool isEmpty() const { return m_links.empty(); }

    /// True if forces alone changed the velocity of the link's multibody in this step: no contact, motor, limit or
    /// joint acts on it. Only after add() with a step.
    bool isFree(int index) const;

    /// Adds an impulse [N s] and an angular impulse [N m s] about the centre of rigid proxy `index`. Ignored if that is
    /// no link.
    void addImpulse(int index, const Vec3& impulse, const Vec3& angular);

    /// Applies the impulses to the multibodies' velocities with a single rounding, moves the multibodies by the
    /// position corrections of the rigid proxies in `step` [s], and wakes those that felt an impulse.
    void apply(const std::vector<RigidProxy>& rigidProxies, double step);

private:
    friend class LinkDeltas;

    struct Tree
    {
        btMultiBody* m_body;
        int m_coordinates;    // base: three angular, three linear; then the joints
        std::size_t m_first;  // in m_velocity, m_freeVelocity
        bool m_isFree;        // forces alone changed its velocity
    };
    struct Link
    {
        int m_rigidProxy;  // -1: let go
        int m_tree;
        int m_index;          // of the link in its multibody; -1: the base; not read if it has rows of Bullet's
        std::size_t m_first;  // of its six rows in m_jacobian and m_answer: three of velocity, three of spin
        Vec3 m_impulse, m_angularImpulse;
        Vec3 m_push, m_angularPush;  // impulses of the position correction, if it was let go
    };

    int treeOf(btMultiBody& body, double step);
    Link& addLink(int index, int tree, int link);
    void setProxy(const Link& link, RigidProxy& rigidProxy) const;
    RigidResponse response(const Link& moved, const Link& pushed) const;
    LinkMotion motion(const Link& link, const std::vector<double>& velocity) const;
    bool solve(const Tree& tree, int number, const std::vector<RigidProxy>* pushed);
    void displace(const Tree& tree, double step);

    ArticulatedHistory m_history;
    MultiBodyDynamics m_dynamics;
    std::vector<Tree> m_trees;
    std::vector<Link> m_links;
    std::vector<double> m_velocity, m_freeVelocity;  // per tree, per coordinate
    std::vector<btScalar> m_jacobian, m_answer;      // J, and J M^-1
    std::vector<btScalar> m_other, m_otherAnswer;    // scratch of addBetween: rows of the other link
    std::vector<double> m_force;                     // generalized force on one tree
    std::vector<btScalar> m_impulse, m_change;       // scratch per coordinate of one tree
};

}  // namespace bullet_fem
