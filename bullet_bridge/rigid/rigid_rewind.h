// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "BulletDynamics/ConstraintSolver/btTypedConstraint.h"
#include "LinearMath/btTransform.h"
#include "bullet_bridge/rigid/manifold_impulses.h"
#include "bullet_bridge/rigid/rigid_objects.h"
#include "bullet_bridge/rigid/sorted_index.h"

class btBroadphaseInterface;
class btCollisionObject;
class btDispatcher;
class btDynamicsWorld;
class btPersistentManifold;
class btRigidBody;
class btSoftBody;

namespace bullet_fem
{

/// Puts islands of rigid bodies, which Bullet has solved and moved without soft bodies, back to the start of the step,
/// so that they can be solved with these and moved again. Knows the world by a soft body's world info: the bodies from
/// its broadphase, contacts from its dispatcher, constraints from the bodies that refer to them. Constraints that none
/// refers to are known from noteWorld(), or recognised by the velocity change that nothing else explains. Grows with
/// the world, never shrinks.
class RigidRewind
{
public:
    /// Call before Bullet's rigid solver, after forces and damping: notes the state of all movable rigid bodies, awake
    /// or not.
    void note(const btSoftBody& soft);

    /// Call at most once between note() and Bullet's rigid solver: notes the constraints of the world that no body
    /// refers to (addConstraint() without disableCollisionsBetweenLinkedBodies).
    void noteWorld(btDynamicsWorld& world);

    /// Forgets what was noted.
    void forget();

    /// Call after Bullet has moved the bodies, in a step of `step` [s]. Finds the islands. False if nothing was noted.
    bool begin(double step);

    /// True if the world contains the object, which may be deleted.
    bool holds(const btCollisionObject* object) const;

    /// Puts the island of an object back. False if that is impossible: the object is no noted body or part of an
    /// island with links of multibodies, unknown constraints or bodies that the program has moved since.
    bool rewind(const btCollisionObject& object);

    /// The velocity that Bullet's solver gave a body which was put back; null for other objects.
    const LinkMotion* motionByBullet(const btCollisionObject& object) const
    {
        const int k = indexOf(&object);
        return k >= 0 && m_bodies[k].m_isBack ? &m_bodies[k].m_byBullet : nullptr;
    }

    /// The constraints of noted bodies and of the world since begin(), by address; one may occur more than once.
    const std::vector<const btTypedConstraint*>& presentConstraints() const { return m_presentConstraints; }

    /// True if the object is a noted body.
    bool isNoted(const btCollisionObject& object) const { return indexOf(&object) >= 0; }

    /// Puts all islands but those of the given objects forward again, to where Bullet had moved them.
    template <class Objects>
    void keepOnly(const Objects& objects)
    {
        m_keeps.assign(m_bodies.size(), 0);
        for (const btCollisionObject* object : objects)
            if (const int k = m_byBody.find(object); k >= 0 && m_bodies[k].m_isBack) m_keeps[root(k)] = 1;
        putForward();
    }
    void keepNone() { keepOnly(std::vector<const btCollisionObject*>()); }

    /// The rewound islands, after keepOnly(): bodies, contacts and enabled constraints, in an order that does not
    /// depend on addresses.
    std::vector<btCollisionObject*>& bodies() { return m_back; }
    std::vector<btPersistentManifold*>& manifolds() { return m_manifolds; }
    std::vector<btTypedConstraint*>& constraints() { return m_constraints; }

    /// Call when these are solved: moves the bodies, and adds the changes that callbacks made to velocities and forces
    /// after Bullet's solver. An island that slept, none of whose bodies is active now, keeps its state.
    void move();

private:
    struct State
    {
        btTransform m_transform = btTransform::getIdentity();
        btVector3 m_linear{0, 0, 0}, m_angular{0, 0, 0}, m_force{0, 0, 0}, m_torque{0, 0, 0};
    };

    struct Noted
    {
        btRigidBody* m_body = nullptr;
        int m_id = 0;  // of the broadphase
        State m_before, m_after;
        LinkMotion m_byBullet;
        btVector3 m_linearByCallbacks{0, 0, 0}, m_angularByCallbacks{0, 0, 0};  // velocity changes since the solver
        btVector3 m_explained{0, 0, 0};  // linear impulse by contacts and known constraints [N s]
        btScalar m_explainedParts = 0;   // sum of the norms of these impulses [N s]
        btScalar m_pushed = 0;           // largest displacement that Bullet may have corrected a penetration by [m]
        int m_parent = 0;                // union-find
        bool m_isMoved = false;          // by Bullet: it is awake
        bool m_isBad = false, m_isBack = false, m_isWoken = false;
    };

    // A constraint between noted bodies, with the feedback that tells its impulse in Bullet's own solve.
    struct Constraint
    {
        btTypedConstraint* m_constraint = nullptr;
        btJointFeedback m_feedback;
        btJointFeedback* m_given = nullptr;  // address of m_feedback when it was given; null: the program has its own
        bool m_isEnabled = false;
    };

    static State stateOf(const btRigidBody& body);
    static void setState(btRigidBody& body, const State& state);
    int root(int k);
    void join(int a, int b);
    int indexOf(const btCollisionObject* object) const { return m_byBody.find(object); }
    void indexBodies();
    void noteConstraints();
    void noteConstraint(btTypedConstraint& constraint);
    void giveFeedback();
    void listReferred();
    bool isPresent(const btTypedConstraint* constraint) const;
    void dropRemoved();
    void readConstraints();
    void readManifolds();
    static void explain(Noted& noted, const btVector3& impulse);
    void checkBody(Noted& noted) const;
    void putForward();
    void listIsland();

    btBroadphaseInterface* m_broadphase = nullptr;
    btDynamicsWorld* m_world = nullptr;  // null: unknown in this step
    btDispatcher* m_dispatcher = nullptr;
    double m_step = 0;  // [s]
    std::vector<Noted> m_bodies;
    SortedIndex<const btCollisionObject*> m_byBody;
    std::vector<Constraint> m_known;
    ManifoldImpulses m_impulses;  // at the end of the last step
    std::vector<btPersistentManifold*> m_allManifolds;
    std::vector<unsigned char> m_keeps;  // per root
    std::vector<btCollisionObject*> m_back;
    std::vector<btPersistentManifold*> m_manifolds;
    std::vector<btTypedConstraint*> m_constraints;
    std::vector<const btCollisionObject*> m_present;             // scratch, sorted by address
    std::vector<const btTypedConstraint*> m_presentConstraints;  // scratch, sorted by address
};

}  // namespace bullet_fem
