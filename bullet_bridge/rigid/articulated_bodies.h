// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "LinearMath/btMatrix3x3.h"
#include "bullet_fem/fem/contact/contact_solver.h"

class btMultiBody;
class btMultiBodyLinkCollider;
struct btMultiBodyJointFeedback;

namespace bullet_fem
{

/// Velocities of a rigid thing.
struct LinkMotion
{
    Vec3 m_linear;   ///< of its centre of mass [m/s]
    Vec3 m_angular;  ///< [rad/s]
};

/// Bullet's multibodies, of which soft bodies touch or hold links. In joint coordinates q an impulse f and an angular
/// impulse t on link a change the velocities by
///     dq' = M^-1 J_a^T (t, f)        and link b moves by J_b dq'
/// with M from Bullet's articulated body algorithm at the present pose. So links answer as what hangs on their joints
/// makes them, and all links of a multibody feel what one of them gets [Featherstone 2008, chapters 7, 11].
class ArticulatedBodies
{
public:
    /// True if impulses move the link: neither it nor all that it hangs on is static, kinematic or asleep for good.
    static bool canMove(const btMultiBodyLinkCollider& link);

    /// True if Bullet does not step the multibody, because one of its islands sleeps.
    static bool sleeps(const btMultiBody& body);

    /// Forgets velocities from before the rigid solver, and what was given to multibodies not touched in the last step.
    void beginStep();

    /// From now on for Bullet's deformable world: it adds forces and gravity to velocities before noteBeforeSolve, and
    /// takes gravity [m/s2], which is that of the world, from the forces then.
    void assumeForcesGiven(const Vec3& gravity);

    /// Remembers how fast a multibody is before Bullet's rigid solver. One thread at a time.
    void noteBeforeSolve(const btMultiBody& body);

    /// Forgets all links.
    void clear();

    /// The same where Bullet's rigid solver is about to solve the multibody: its velocity is the present one, which has
    /// all forces in it.
    LinkMotion addBeforeSolve(int index, const btMultiBodyLinkCollider& link, RigidProxy& rigidProxy);

    /// Within Bullet's rigid solver, once it has set its rows up: `deltas` are what these change of the multibodies'
    /// velocities, at their companion ids. What soft bodies give is added to them, so that Bullet's rows see it; the
    /// multibodies get that by apply().
    void beginSolve(btAlignedObjectArray<btScalar>& deltas);
    /// The rigid proxies' velocities become those of the links at present.
    void readSolved(std::vector<RigidProxy>& rigidProxies) const;
    /// Adds what the rigid proxies have felt since beginSolve() or the last call.
    void writeSolved(const std::vector<RigidProxy>& rigidProxies);

    /// Makes rigid proxy number `index` that of a link which can move. Its velocity is the one that it has next without
    /// soft bodies: with what forces, gravity and Coriolis' ones add in `step` [s], and with what contacts, motors and
    /// limits hold it with: in every joint what they did in this step, as far as it withstands the forces and what soft
    /// bodies gave before. Returns the velocity that it has now. The order of calls decides the order of responses.
    LinkMotion add(int index, const btMultiBodyLinkCollider& link, double step, RigidProxy& rigidProxy);

    /// From now on velocities and impulses of rigid proxy number `index` are about a point at `center` [m] that goes
    /// with the link.
    void setCenter(int index, const Vec3& center);

    /// Writes how links answer impulses. Once all links are known; it may be called again when there are more.
    void connect(std::vector<RigidProxy>& rigidProxies, std::vector<RigidResponse>& responses) const;

    bool isEmpty() const { return m_links.empty(); }

    /// Adds to what rigid proxy number `index` gets, about its centre [N s], [N m s]; nothing if it is no link.
    void addImpulse(int index, const Vec3& impulse, const Vec3& angular);

    /// Gives the multibodies their impulses, once each and rounded once, moves them by the position corrections of the
    /// rigid proxies in `step` [s], and wakes those that felt something.
    void apply(const std::vector<RigidProxy>& rigidProxies, double step);

private:
    struct Before
    {
        const btMultiBody* m_body;
        std::size_t m_first;  // in m_beforeVelocity
    };
    // What lasts from step to step.
    struct Memory
    {
        const btMultiBody* m_body = nullptr;  // only compared; null: free
        bool m_used = false;                  // in this step
        std::vector<double> m_given;          // by soft bodies, in the last step, per coordinate [m/s], [rad/s]
        std::vector<double> m_remainder;      // cut off its velocity by rounding, likewise
    };
    struct Tree
    {
        btMultiBody* m_body;
        int m_coordinates;    // base: three of spin, three of velocity; then those of the joints
        std::size_t m_first;  // in m_velocity, m_freeVelocity
    };
    struct Link
    {
        int m_rigidProxy, m_tree;
        int m_index;          // of the link in its multibody; -1: the base
        std::size_t m_first;  // of its six rows in m_jacobian and m_answer: three of velocity, three of spin
        Vec3 m_impulse, m_angularImpulse;
        Vec3 m_felt, m_angularFelt;  // of the rigid proxy, when it was written last
    };

    struct Momentum
    {
        Vec3 m_linear, m_angular;  // about the world's origin
    };

    LinkMotion addLink(int index, const btMultiBodyLinkCollider& link, int tree, RigidProxy& rigidProxy);
    int treeOf(btMultiBody& body);
    int find(const btMultiBody& body) const;
    double changeIn(const Tree& tree, int k) const;
    void reserve(const Tree& tree);
    void factor(btMultiBody& body);
    void predict(const Tree& tree, double step);
    void addSupport(const Tree& tree, double step);
    void support(const Tree& tree, int first, int count, const double* before, double step);
    void fillRows(const Link& link, const Vec3& center);
    Mat3 block(const Link& moved, int rowOfMoved, const Link& pushed, int rowOfPushed) const;
    RigidResponse response(const Link& moved, const Link& pushed) const;
    LinkMotion motion(const Link& link, const std::vector<double>& velocity) const;
    bool solve(const Tree& tree, int number, const std::vector<RigidProxy>* pushed);
    void addVelocity(const Tree& tree);
    void displace(const Tree& tree, double step);
    Momentum momentum(const btMultiBody& body);
    Memory& memoryOf(const btMultiBody& body, int coordinates);

    bool m_forcesGiven = false;  // before noteBeforeSolve
    Vec3 m_takenGravity;         // that forces lack then
    std::vector<Before> m_before;
    std::vector<double> m_beforeVelocity;
    std::vector<Memory> m_memories;
    std::vector<Tree> m_trees;
    std::vector<Link> m_links;
    std::vector<double> m_velocity, m_freeVelocity;      // per tree, of its coordinates
    btAlignedObjectArray<btScalar>* m_deltas = nullptr;  // Bullet's
    std::vector<double> m_beyondDeltas;          // per tree, of its coordinates: what is not in them, but was given
    mutable std::vector<double> m_solved;        // scratch of readSolved
    std::vector<double> m_acceleration;          // of one tree
    std::vector<btScalar> m_jacobian, m_answer;  // J, and J M^-1
    std::vector<double> m_force;                 // of one tree
    std::vector<btScalar> m_rounded, m_change;   // likewise
    std::vector<btMultiBodyJointFeedback*> m_feedback;
    btAlignedObjectArray<btScalar> m_scalars;  // scratch of Bullet's functions
    btAlignedObjectArray<btVector3> m_vectors;
    btAlignedObjectArray<btMatrix3x3> m_matrices;
    btAlignedObjectArray<btQuaternion> m_turns;
};

}  // namespace bullet_fem
