// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <mutex>
#include <vector>

#include "LinearMath/btVector3.h"
#include "bullet_bridge/rigid/articulated_bodies.h"
#include "bullet_fem/fem/contact/contact_solver.h"

class btCollisionObject;
class btMultiBodyLinkCollider;
class btRigidBody;

namespace bullet_fem
{

/// When the rigid side is looked at.
enum class RigidPhase
{
    moved,   ///< Bullet has solved and moved the rigid bodies; they feel the soft ones after that
    solving  ///< Bullet's rigid solver is about to solve them, together with the soft ones
};

/// The rigid side of a step's contacts and joints: turns Bullet's collision objects into rigid proxies, and hands the
/// reactions back. Links of multibodies answer as parts of their multibody. What single precision cuts off a rigid
/// body's velocity is carried to the next step.
class RigidProxies
{
public:
    /// What single precision cut off a body's velocity.
    struct Remainder
    {
        int m_objectId = -1;
        Vec3 m_linear, m_angular;                  ///< [m/s], [rad/s]
        bool m_used = false;                       ///< in this step
        Vec3 m_linearGiven, m_angularGiven;        ///< what soft bodies gave it in the last step [m/s], [rad/s]
        Vec3 m_linearExpected, m_angularExpected;  ///< and what of it they are expected to give again
    };

    /// What the next step depends on.
    struct Memory
    {
        std::vector<Remainder> m_remainders;
        std::vector<int> m_rewound;  ///< broadphase ids
    };
    Memory memory() const { return {m_remainders, m_rewound}; }
    void restore(const Memory& memory);

    /// Forgets the remainders of bodies that were not touched in the last step. `step` of the world [s].
    void beginStep(double step);

    /// Remembers how fast a body is before Bullet's rigid solver. One that Bullet's joints hold gets what soft bodies
    /// are expected to give it, so that the joints withstand it; the reactions are less by that. May be called by
    /// several threads at once.
    void noteBeforeSolve(const btCollisionObject& object);

    /// See ArticulatedBodies::assumeForcesGiven.
    void assumeForcesGiven(const Vec3& gravity) { m_articulated.assumeForcesGiven(gravity); }

    /// Forgets all rigid proxies.
    void clear(RigidPhase phase = RigidPhase::moved);

    /// Index of an object's rigid proxy, made when first asked for. `step` [s] is the world's. Rows use the velocity
    /// that a dynamic body will have next without soft bodies: in phase `moved` v + h g, and what other rigid bodies
    /// hold it with (see supportOf); else v and what all its forces add.
    int indexOf(const btCollisionObject& object, double step);

    /// The same for contacts with a soft body, after its free motion. Where the two move fast relative to each other
    /// (as isFast() has it) in phase `moved`, the rigid one is rewound: its rigid proxy is where Bullet moved it from,
    /// with the velocity that it moved with; what Bullet's joints did to it holds it. It stays so as long as it is
    /// asked for in every step. One that was asked for before in this step stays as it is.
    int indexForContact(const btCollisionObject& object, double step, const Body& soft);

    /// The same for joints. In phase `moved` a rigid body that Bullet's own joints do not hold is rewound: where it is
    /// as the step ends is what the joint is about, and a stiff link that were told a step late would shake it off.
    int indexForJoint(const btCollisionObject& object, double step);

    /// The same for what Bullet's contacts keep apart from a rigid proxy, and which is rewound if that is.
    int indexBeside(const btCollisionObject& object, double step, int neighbour);

    RigidPhase phase() const { return m_phase; }

    /// True if Bullet has moved the object already, but its rigid proxy is as the step began.
    bool isRewound(int rigidProxy) const { return m_sources[rigidProxy].m_rewound; }

    /// Writes how links of multibodies answer impulses, for ContactProblem. Once all rigid proxies are known.
    void connectLinks(std::vector<RigidResponse>& responses) { m_articulated.connect(m_rigidProxies, responses); }

    /// True if the rigid proxy is a multibody's link that impulses can move.
    bool isMovableLink(int rigidProxy) const
    {
        return m_rigidProxies[rigidProxy].canMove() && !movableBody(rigidProxy);
    }

    /// True if a rigid proxy is rewound.
    bool holdsRewound() const;

    /// True if links of multibodies that can move are among the rigid proxies.
    bool holdsLinks() const { return !m_articulated.isEmpty(); }

    /// Of the links, within Bullet's rigid solver: see ArticulatedBodies.
    void beginLinks(btAlignedObjectArray<btScalar>& deltas) { m_articulated.beginSolve(deltas); }
    void readLinks(std::vector<RigidProxy>& rigidProxies) const { m_articulated.readSolved(rigidProxies); }
    void writeLinks(const std::vector<RigidProxy>& rigidProxies) { m_articulated.writeSolved(rigidProxies); }

    /// The velocity that the object moves with, or moved with: without what gravity will add to it in the next step.
    LinkMotion motionNow(int rigidProxy) const;

    std::vector<RigidProxy>& rigidProxies() { return m_rigidProxies; }
    const std::vector<RigidProxy>& rigidProxies() const { return m_rigidProxies; }
    const btCollisionObject& object(int rigidProxy) const { return *m_sources[rigidProxy].m_object; }

    /// The rigid body of a rigid proxy that impulses can move; null for others.
    btRigidBody* movableBody(int rigidProxy) const;
    Remainder& remainder(int rigidProxy) { return remainderOf(m_sources[rigidProxy].m_objectId); }

    /// Moves the bodies by the position corrections, and rewound ones by what their change of velocity makes (touches
    /// included, so that a floor stays a floor; but for what goes against Bullet's joints), and wakes those that felt
    /// impulses; in phase `moved` also adds the changes to their velocities, in double and once. `problem` is the one
    /// solved, with these rigid proxies. `lasts`: soft bodies will give the like in the next step.
    void applyReactions(const ContactProblem& problem, double step, bool lasts = true);

private:
    struct Source
    {
        const btCollisionObject* m_object = nullptr;
        int m_objectId = -1;
        Vec3 m_linearImpulse, m_angularImpulse;  // of all contacts and joints, on the rigid body
        bool m_rewound = false;
        Vec3 m_held;  // of a rewound body that Bullet's joints hold: what they and contacts gave it in this step [m/s]
        LinkMotion m_now = {};  // as the solve began; of rigid bodies and links that can move
    };

    struct Before
    {
        const btCollisionObject* m_object;
        Vec3 m_linear, m_angular;
        LinkMotion m_expected = {};   // what forces in place of soft bodies give; 0 once it is accounted for
        btVector3 m_force, m_torque;  // without these [N], [N m]
        bool m_pushed = false;        // these forces are on it
    };

    // Proxies of the problem behind these are cloth's; -1 is none.
    bool isOurs(int rigidProxy) const { return rigidProxy >= 0 && rigidProxy < static_cast<int>(m_sources.size()); }
    void addReaction(int rigidProxy, const Vec3& impulse, const Vec3& arm);
    void addJointReaction(const JointEnd& end, const Vec3& impulse);
    void addToVelocity(btRigidBody& body, const Source& source, const LinkMotion& change, bool lasts);
    LinkMotion takeExpected(const btCollisionObject& object);
    void expect(btRigidBody& body, Before& before);
    void takeBack(const btCollisionObject& object);
    static void clearPush(Before& before);
    void returnExpected();
    LinkMotion doneByBullet(const btRigidBody& body, double step, const RigidProxy& rigidProxy) const;
    LinkMotion supportOf(const btRigidBody& body, double step, const RigidProxy& rigidProxy, bool rewound);
    void rewind(int rigidProxy, double step);
    bool mustRewind(int rigidProxy, double step, const Body& soft) const;
    Remainder& remainderOf(int objectId);

    RigidPhase m_phase = RigidPhase::moved;
    std::vector<RigidProxy> m_rigidProxies;
    std::vector<Source> m_sources;
    std::vector<Remainder> m_remainders;
    double m_step = 0;  // [s]
    std::mutex m_beforeMutex;
    std::vector<Before> m_before;               // velocities before Bullet's rigid solver
    std::vector<int> m_rewound, m_lastRewound;  // ids of the objects in this step and in the last
    std::vector<btVector3> m_linkVelocities;    // scratch
    ArticulatedBodies m_articulated;
};

/// A rigid body that impulses can move; null for static, kinematic and foreign objects.
btRigidBody* movableBody(const btCollisionObject& object);

/// A link of a multibody that is still there; null for other objects.
const btMultiBodyLinkCollider* linkOf(const btCollisionObject& object);

/// True if one of them is not 0.
inline bool isAny(const Vec3& linear, const Vec3& angular)
{
    return dot(linear, linear) + dot(angular, angular) > 0;
}

/// Adds `change` to a Bullet velocity, with what rounding cut off before, and keeps what it cuts off now.
btVector3 addedExactly(const btVector3& velocity, const Vec3& change, Vec3& remainder);

/// Bullet's id of an object in its broadphase: unique in a world and never reused; -1 outside a world.
int broadphaseId(const btCollisionObject& object);

}  // namespace bullet_fem
