// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <mutex>
#include <vector>

#include "bullet_bridge/rigid/articulated_bodies.h"
#include "bullet_bridge/rigid/rigid_history.h"
#include "bullet_bridge/rigid/rigid_rewind.h"

namespace bullet_fem
{

/// When the rigid bodies are coupled with the soft ones.
enum class RigidPhase
{
    moved,   ///< after Bullet has solved and moved the rigid bodies (staggered)
    solving  ///< within Bullet's rigid solver, simultaneously (monolithic)
};

/// The rigid side of a step's contacts and joints: makes rigid proxies of Bullet's collision objects and applies the
/// reactions to them. Links of multibodies respond as parts of their multibody.
class RigidProxies
{
public:
    /// State of rigid bodies from step to step; call beginStep() of this and of links().
    RigidHistory& history() { return m_history; }
    /// The multibodies with links among the rigid proxies.
    ArticulatedBodies& links() { return m_links; }
    const ArticulatedBodies& links() const { return m_links; }

    /// Notes a body's velocity before Bullet's rigid solver. May be called by several threads at once.
    void noteBeforeSolve(const btCollisionObject& object);

    /// Forgets all rigid proxies. `rewind`: bodies that it has put back are expected to move as Bullet has moved them;
    /// must live until the next call. `constraints`, `count`: those of Bullet's island, to which bodies need not refer.
    void clear(RigidPhase phase = RigidPhase::moved, const RigidRewind* rewind = nullptr,
               const btTypedConstraint* const* constraints = nullptr, std::size_t count = 0);

    /// Index of an object's rigid proxy; -1 if there is none.
    int find(const btCollisionObject& object) const { return m_byObject.find(&object); }

    /// Index of an object's rigid proxy, which is made at the first call. `step` is the world's [s]. A dynamic body's
    /// proxy has the predicted velocity without soft bodies: in phase `moved` v + h g plus its support by other rigid
    /// bodies (see RigidHistory::supportOf), in phase `solving` v plus the effect of all its forces, or the velocity
    /// that Bullet gave it before it was put back.
    int indexOf(const btCollisionObject& object, double step);

    /// indexOf() for contacts with a soft body, after its free motion. In phase `moved`, an object with fast relative
    /// motion (see isFast) is rewound: its proxy is at the position before Bullet moved it, with the velocity of that
    /// motion and the support by Bullet's joints. It remains rewound while it is requested in every step. A proxy that
    /// exists already in this step is returned unchanged.
    int indexForContact(const btCollisionObject& object, double step, const Body& soft);

    /// indexOf() for joints. In phase `moved`, a rigid body without Bullet's own joints is rewound, and a link on whose
    /// multibody Bullet's solver did not act: the joint constrains the position at the end of the step, and a stiff
    /// joint that reacts one step late becomes unstable.
    int indexForJoint(const btCollisionObject& object, double step);

    /// indexOf() for an object in contact with rigid proxy `neighbour` by Bullet; it is rewound if the neighbour is.
    int indexBeside(const btCollisionObject& object, double step, int neighbour);

    RigidPhase phase() const { return m_phase; }

    /// True if Bullet has moved the object already, while its proxy is at the start of the step.
    bool isRewound(int rigidProxy) const { return m_sources[rigidProxy].m_rewound; }

    /// True if a constraint acts on the body: one that it refers to, or one given to clear() or known to its `rewind`.
    bool isConstrained(const btRigidBody& body) const;

    bool holdsRewound() const
    {
        return std::any_of(m_sources.begin(), m_sources.end(), [](const Source& source) { return source.m_rewound; });
    }

    /// The velocity with which the object moves, or moved, in this step, without the gravity of the next step.
    LinkMotion motionNow(int rigidProxy) const;

    /// The rigid proxies made since clear(), by index.
    std::vector<RigidProxy>& rigidProxies() { return m_rigidProxies; }
    const std::vector<RigidProxy>& rigidProxies() const { return m_rigidProxies; }

    /// The collision object of a rigid proxy.
    const btCollisionObject& object(int rigidProxy) const { return *m_sources[rigidProxy].m_object; }

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
        Vec3 m_linearImpulse, m_angularImpulse;  // sum over contacts and joints, on the rigid body
        bool m_rewound = false;
        Vec3 m_held;  // of a rewound body with Bullet's joints: velocity change by joints and contacts in this step
                      // [m/s]
        LinkMotion m_now = {};  // velocity as the solve began, of movable objects
    };

    void rewind(int rigidProxy, double step);

    RigidPhase m_phase = RigidPhase::moved;
    const RigidRewind* m_rewind = nullptr;  // null: none
    std::vector<RigidProxy> m_rigidProxies;
    std::vector<Source> m_sources;
    SortedIndex<const btCollisionObject*> m_byObject;  // m_sources by object
    std::vector<const btRigidBody*> m_constrained;     // bodies of noted constraints, sorted by address
    RigidHistory m_history;
    std::mutex m_beforeMutex;
    std::vector<btVector3> m_linkVelocities;  // scratch
    ArticulatedBodies m_links;
};

/// True if the rigid proxy is a movable link of a multibody.
inline bool isMovableLink(const RigidProxies& proxies, int rigidProxy)
{
    return proxies.rigidProxies()[rigidProxy].canMove() && !movableBody(proxies.object(rigidProxy));
}

}  // namespace bullet_fem
