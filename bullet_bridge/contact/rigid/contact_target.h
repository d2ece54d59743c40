// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/contact/carrying_planes.h"
#include "bullet_bridge/contact/rigid/search_scope.h"
#include "bullet_bridge/geometry/shapes/shape_distance.h"
#include "bullet_bridge/geometry/shapes/swept_distance.h"
#include "bullet_bridge/rigid/rigid_proxies.h"

namespace bullet_fem
{

/// An object near a body, as input of the contact search.
struct ContactObject
{
    const btCollisionObject* m_object;
    int m_rigidProxy;              ///< index of its rigid proxy
    int m_firstLeaf, m_leafCount;  ///< leaves of its shape, posed as its rigid proxy is
    bool m_unknownShape;           ///< a part of its shape has no contact support
    CarryingPlane m_carrying;
    Vec3 m_advance;  ///< displacement along the soft surfaces that it rolls on, which its leaves have made already [m]
    bool m_mayBeStopped;  ///< within a step: it can move, and is on joints or near other objects than the body
};

/// Input of a body's contact search.
struct RigidSurroundings
{
    const ContactObject* m_touched;  ///< objects near the body, by ascending broadphase id, m_count of them
    int m_count;
    const btAlignedObjectArray<ShapeLeaf>& m_leaves;
    const std::vector<RigidProxy>& m_rigidProxies;
    double m_step;      ///< time step [s]
    int m_maxContacts;  ///< largest number of contacts of the body
};

/// Contact parameters of a pair of surfaces; see ContactPoint for the units.
struct SurfacePair
{
    double m_hardness = 1, m_friction = 0, m_restitution = 0, m_stiffness = 0, m_damping = 0;
};

enum class TargetKind
{
    slow,   ///< convex; neither shape nor body moves far within the step
    fast,   ///< convex; contacts are searched on the paths
    sheets  ///< two-sided triangles
};

/// One leaf of an object's shape to be tested, with its motion and the step.
struct ContactTarget
{
    const ShapeLeaf* m_shape;
    const btCollisionObject* m_object;
    int m_leaf;                  ///< index among the object's leaves
    int m_rigidProxy;            ///< index of the object's rigid proxy
    const RigidProxy* m_motion;  ///< as the step begins
    Vec3 m_moved;  ///< displacement of its centre that Bullet has applied already, of kinematic objects [m]
    SurfacePair m_surface;
    double m_reach;  ///< distance up to which contact is possible within the step [m]
    Vec3 m_fall;    ///< displacement by gravity that is missing in the free approach if one of the two is supported [m]
    double m_step;  ///< [s]
    const CarryingPlane* m_carrying;
    Vec3 m_advance;            ///< see ContactObject; m_motion begins after it
    bool m_mayBeStopped;       ///< see ContactObject
    const SolidPlace* m_last;  ///< place in the last search, of a movable solid; null: none
    TargetKind m_kind;
    std::size_t m_first, m_end;          ///< range of its contacts in the list of near ones
    std::size_t m_firstSide, m_endSide;  ///< range in SheetSearch::sides(), of sheets
};

/// The targets of a body's search. Scratch grows with their number, never shrinks.
class ContactTargets
{
public:
    /// Lists all leaves of all objects near the body, which must stay where they are. Sets the scope's fastest node,
    /// and begins its culling.
    void list(SearchScope& scope, const RigidSurroundings& around);

    std::vector<ContactTarget>& targets() { return m_targets; }
    const std::vector<ContactTarget>& targets() const { return m_targets; }

    void reserve(std::size_t targets) { m_targets.reserve(targets); }

private:
    const RigidProxy& asTheStepBegan(const ContactObject& touched, const RigidSurroundings& around);

    std::vector<ContactTarget> m_targets;
    std::vector<RigidProxy> m_starts;  // proxies of kinematic objects as the step begins, of rolling ones as advanced
};

/// The body's broad phase, with its pairs; null if it is not known.
btBroadphaseInterface* broadphaseOf(const FemSoftBody& fem);

/// True if the target has an inside and can move.
bool isMovableSolid(const ContactTarget& target);

/// The target's motion within the step.
SweptShape sweptShapeOf(const ContactTarget& target);

/// True if target or body move so far within the step that gaps and normals of its beginning mean nothing.
bool isFastTarget(const SearchScope& scope, const ContactTarget& target);

/// True if a point may have made a way relative to the target since the last search; else the program has placed the
/// body or the object anew.
bool mayHaveGone(const SearchScope& scope, const ContactTarget& target, const Vec3& way);

/// True if the middle of a solid target is inside an element of the body, so that no contact shows the way out. Not
/// with a skin.
bool isEnclosed(const SearchScope& scope, const ContactTarget& target);

}  // namespace bullet_fem
