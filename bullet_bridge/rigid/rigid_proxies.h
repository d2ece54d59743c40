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

/// When the rigid bodies are coupled with the soft ones.
enum class RigidPhase
{
    moved,   ///< after Bullet has solved and moved the rigid bodies (staggered)
    solving  ///< within Bullet's rigid solver, simultaneously (monolithic)
};

/// The rigid side of a step's contacts and joints: makes rigid proxies of Bullet's collision objects and applies the
/// reactions to them. Links of multibodies respond as parts of their multibody. The rounding error of a rigid body's
/// velocity in single precision is carried to the next step.
class RigidProxies
{
public:
    /// State of a rigid body from step to step.
    struct Remainder
    {
        int m_objectId = -1;
        Vec3 m_linear, m_angular;                  ///< rounding error of its velocity [m/s], [rad/s]
        bool m_used = false;                       ///< it took part in this step: the next beginStep() keeps it
        Vec3 m_linearGiven, m_angularGiven;        ///< velocity change by soft bodies in the last step [m/s], [rad/s]
        Vec3 m_linearExpected, m_angularExpected;  ///< part of it that is expected again [m/s], [rad/s]
    };

    /// The state on which the next step depends.
    struct Memory
    {
        std::vector<Remainder> m_remainders;
        std::vector<int> m_rewound;  ///< broadphase ids of rewound objects
    };

    /// A copy of that state.
    Memory memory() const { return {m_remainders, m_rewound}; }

    /// Replaces the state by that of a former memory().
    void restore(const Memory& memory);

    /// Forgets the state of bodies that took no part in the last step. `step` is the world's [s].
    void beginStep(double step);

    /// Notes a body's velocity before Bullet's rigid solver. A body with Bullet's joints gets the expected reaction of
    /// soft bodies in advance, so that its joints withstand it; the reaction to apply is smaller by that. May be called
    /// by several threads at once.
    void noteBeforeSolve(const btCollisionObject& object);

    /// See ArticulatedBodies::assumeForcesGiven.
    void assumeForcesGiven(const Vec3& gravity) { m_articulated.assumeForcesGiven(gravity); }

    /// Forgets all rigid proxies.
    void clear(RigidPhase phase = RigidPhase::moved);

    /// Index of an object's rigid proxy, which is made at the first call. `step` is the world's [s]. A dynamic body's
    /// proxy has the predicted velocity without soft bodies: in phase `moved` v + h g plus its support by other rigid
    /// bodies (see supportOf), in phase `solving` v plus the effect of all its forces.
    int indexOf(const btCollisionObject& object, double step);

    /// indexOf() for contacts with a soft body, after its free motion. In phase `moved`, an object with fast relative
    /// motion (see isFast) is rewound: its proxy is at the position before Bullet moved it, with the velocity of that
    /// motion and the support by Bullet's joints. It remains rewound while it is requested in every step. A proxy that
    /// exists already in this step is returned unchanged.
    int indexForContact(const btCollisionObject& object, double step, const Body& soft);

    /// indexOf() for joints. In phase `moved`, a rigid body without Bullet's own joints is rewound: the joint
    /// constrains the position at the end of the step, and a stiff joint that reacts one step late becomes unstable.
    int indexForJoint(const btCollisionObject& object, double step);

    /// indexOf() for an object in contact with rigid proxy `neighbour` by Bullet; it is rewound if the neighbour is.
    int indexBeside(const btCollisionObject& object, double step, int neighbour);

    RigidPhase phase() const { return m_phase; }

    /// True if Bullet has moved the object already, while its proxy is at the start of the step.
    bool isRewound(int rigidProxy) const { return m_sources[rigidProxy].m_rewound; }

    /// Writes the links' responses to impulses for ContactProblem. Call after all rigid proxies are made.
    void connectLinks(std::vector<RigidResponse>& responses) { m_articulated.connect(m_rigidProxies, responses); }

    /// True if the rigid proxy is a movable link of a multibody.
    bool isMovableLink(int rigidProxy) const
    {
        return m_rigidProxies[rigidProxy].canMove() && !movableBody(rigidProxy);
    }

    /// True if some rigid proxy is rewound.
    bool holdsRewound() const;

    /// True if some rigid proxy is a movable link of a multibody.
    bool holdsLinks() const { return !m_articulated.isEmpty(); }

    /// Links within Bullet's rigid solver: see beginSolve(), readSolved() and writeSolved() of ArticulatedBodies.
    void beginLinks(btAlignedObjectArray<btScalar>& deltas) { m_articulated.beginSolve(deltas); }
    void readLinks(std::vector<RigidProxy>& rigidProxies) const { m_articulated.readSolved(rigidProxies); }
    void writeLinks(const std::vector<RigidProxy>& rigidProxies) { m_articulated.writeSolved(rigidProxies); }

    /// The velocity with which the object moves, or moved, in this step, without the gravity of the next step.
    LinkMotion motionNow(int rigidProxy) const;

    /// The rigid proxies made since clear(), by index.
    std::vector<RigidProxy>& rigidProxies() { return m_rigidProxies; }
    const std::vector<RigidProxy>& rigidProxies() const { return m_rigidProxies; }

    /// The collision object of a rigid proxy.
    const btCollisionObject& object(int rigidProxy) const { return *m_sources[rigidProxy].m_object; }

    /// The movable rigid body of a rigid proxy; null for other objects.
    btRigidBody* movableBody(int rigidProxy) const;

    /// The state of a rigid proxy's object, created if there is none.
    Remainder& remainder(int rigidProxy) { return remainderOf(m_sources[rigidProxy].m_objectId); }

    /// Applies the solution of `problem`, which has these rigid proxies: moves bodies by position corrections, and
    /// rewound ones by their change of velocity too, without its component against Bullet's joints (rigid-rigid
    /// contacts count, so that a floor stays solid); wakes bodies that felt impulses; in phase `moved` adds the
    /// velocity changes, in double precision with one rounding. `step` [s]. `lasts`: soft bodies are expected to push
    /// alike in the next step.
    void applyReactions(const ContactProblem& problem, double step, bool lasts = true);

private:
    struct Source
    {
        const btCollisionObject* m_object = nullptr;
        int m_objectId = -1;
        Vec3 m_linearImpulse, m_angularImpulse;  // sum over contacts and joints, on the rigid body
        bool m_rewound = false;
        Vec3 m_held;  // of a rewound body with Bullet's joints: velocity change by joints and contacts in this step
                      // [m/s]
        LinkMotion m_now = {};  // velocity as the solve began, of movable objects
    };

    struct Before
    {
        const btCollisionObject* m_object;
        Vec3 m_linear, m_angular;
        LinkMotion m_expected = {};   // velocity change by the expected reaction; 0 once it is accounted for
        btVector3 m_force, m_torque;  // total force and torque without it [N], [N m]
        bool m_pushed = false;        // its force is on the body
    };

    // Rigid proxies beyond these belong to cloth; -1 is none.
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
    std::vector<Before> m_before;               // velocities noted before Bullet's rigid solver
    std::vector<int> m_rewound, m_lastRewound;  // broadphase ids of rewound objects in this step and in the last
    std::vector<btVector3> m_linkVelocities;    // scratch
    ArticulatedBodies m_articulated;
};

/// The movable rigid body of an object; null for static, kinematic and other objects.
btRigidBody* movableBody(const btCollisionObject& object);

/// The link of a multibody, if it still exists; null for other objects.
const btMultiBodyLinkCollider* linkOf(const btCollisionObject& object);

/// True if one of the vectors is not 0.
inline bool isAny(const Vec3& linear, const Vec3& angular)
{
    return dot(linear, linear) + dot(angular, angular) > 0;
}

/// Returns velocity + remainder + change rounded to Bullet's precision, and sets `remainder` to the rounding error.
/// Units are those of the velocity.
btVector3 addedExactly(const btVector3& velocity, const Vec3& change, Vec3& remainder);

/// Bullet's broadphase id of an object, unique in a world and never reused; -1 outside a world.
int broadphaseId(const btCollisionObject& object);

}  // namespace bullet_fem
