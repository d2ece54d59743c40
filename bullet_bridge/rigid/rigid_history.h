// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/rigid/rigid_objects.h"
#include "bullet_bridge/rigid/sorted_index.h"
#include "bullet_fem/fem/contact/contact_solver.h"

namespace bullet_fem
{

/// State of movable rigid bodies from step to step, and their velocities before Bullet's rigid solver. The rounding
/// error of a rigid body's velocity in single precision is carried to the next step. A body with Bullet's joints gets
/// the expected reaction of soft bodies in advance, so that its joints withstand it; the reaction to apply is smaller
/// by that.
class RigidHistory
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

    /// Notes a body's velocity before Bullet's rigid solver, and gives it the expected reaction.
    void noteBeforeSolve(btRigidBody& body);

    /// Velocity change by Bullet's contacts and joints in this step of `step` [s].
    LinkMotion doneByBullet(const btRigidBody& body, double step, const RigidProxy& rigidProxy) const;

    /// Predicts the support of a body in the next step: a body on a floor neither falls nor yields to a soft body's
    /// push. It is the change by Bullet's contacts and joints in this step, as far as that balances gravity and the
    /// last impulses of soft bodies; any further change, as of an impact, will not recur. A rewound body is at its
    /// place before that change.
    LinkMotion supportOf(const btRigidBody& body, double step, const RigidProxy& rigidProxy, bool rewound);

    /// Returns the velocity change that a body got in advance, and resets it: 0 at the second call, or if Bullet has
    /// put the body to sleep since.
    LinkMotion takeExpected(const btRigidBody& body);

    /// Takes the expected reaction back before Bullet's rigid solver sees it.
    void takeBack(const btRigidBody& body);

    /// Takes back the expected reactions of bodies that felt none in the end, and restores the forces, which all of
    /// Bullet's sub-steps share.
    void returnExpected();

    /// Adds a velocity change by soft bodies, in double precision with one rounding. `lasts`: as for
    /// RigidProxies::applyReactions.
    void addToVelocity(btRigidBody& body, const LinkMotion& change, bool lasts);

    /// The state of an object, created if there is none.
    Remainder& remainderOf(const btCollisionObject& object);

    /// Notes a rewound object.
    void noteRewound(const btCollisionObject& object) { m_rewound.push_back(broadphaseId(object)); }
    /// True if the object was rewound in the last step.
    bool wasRewound(const btCollisionObject& object) const;

private:
    struct Before
    {
        btRigidBody* m_body;
        Vec3 m_linear, m_angular;
        LinkMotion m_expected = {};   // velocity change by the expected reaction; 0 once it is accounted for
        btVector3 m_force, m_torque;  // total force and torque without it [N], [N m]
        bool m_pushed = false;        // its force is on the body
    };

    void listRemainders();
    void expect(Before& before);
    static void clearPush(Before& before);

    double m_step = 0;  // [s]
    std::vector<Remainder> m_remainders;
    SortedIndex<int> m_remainderOfId;
    std::vector<Before> m_before;  // velocities noted before Bullet's rigid solver
    SortedIndex<const btCollisionObject*> m_beforeOfBody;
    std::vector<int> m_rewound, m_lastRewound;  // broadphase ids of rewound objects in this step and in the last
};

}  // namespace bullet_fem
