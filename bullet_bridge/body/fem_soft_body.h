// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "LinearMath/btMatrix3x3.h"
#include "bullet_bridge/body/collision_skin.h"
#include "bullet_bridge/body/contact_patch.h"
#include "bullet_bridge/body/held_joint.h"
#include "bullet_bridge/body/model_library.h"
#include "bullet_bridge/body/topology_marks.h"
#include "bullet_bridge/geometry/shapes/shape_distance.h"
#include "bullet_bridge/geometry/surface/noted_place.h"
#include "bullet_bridge/geometry/surface/soft_surface.h"
#include "bullet_fem/fem/contact/contact_solver.h"

class btCollisionObject;

namespace bullet_fem
{

/// Identifies a contact point from step to step.
struct ContactOrigin
{
    const btCollisionObject* m_object = nullptr;
    int m_objectId = 0;  ///< broadphase id; contacts are sorted by it
    int m_leaf = 0;      ///< leaf of the object's shape
    int m_feature =
        0;  ///< vertex; then midpoint and nearest point of each edge; then those of each triangle; then corners of the
            ///< shape, a fixed number per triangle. With sheets: vertex, then triangle, then edge
    int m_part = -1;      ///< Bullet's part number of a mesh; -1: not a mesh
    int m_triangle = -1;  ///< Bullet's triangle number in that part

    bool operator<(const ContactOrigin& b) const
    {
        if (m_objectId != b.m_objectId) return m_objectId < b.m_objectId;
        return m_leaf != b.m_leaf ? m_leaf < b.m_leaf : m_feature < b.m_feature;
    }
};

/// Side of a vertex of the collision surface relative to a concave shape nearby, whose sheets have two sides.
struct SheetSide
{
    int m_objectId = 0, m_leaf = 0, m_node = 0;  ///< as in ContactOrigin
    Vec3 m_position;                             ///< last position in the leaf's frame [m]
    Vec3 m_safe;  ///< that position, moved to the right side of all sheets, in the leaf's frame [m]

    bool operator<(const SheetSide& b) const
    {
        if (m_objectId != b.m_objectId) return m_objectId < b.m_objectId;
        return m_leaf != b.m_leaf ? m_leaf < b.m_leaf : m_node < b.m_node;
    }
};

/// A convex shape that can move, at the last contact search.
struct SolidPlace
{
    int m_objectId = 0, m_leaf = 0;  ///< as in ContactOrigin
    Pose m_pose;

    bool operator<(const SolidPlace& b) const
    {
        return m_objectId != b.m_objectId ? m_objectId < b.m_objectId : m_leaf < b.m_leaf;
    }
};

/// The values last written to the btSoftBody's nodes: a component that differs was changed by the user since.
struct WrittenNodes
{
    std::vector<btVector3> m_x, m_v;
    std::vector<btScalar> m_inverseMass;
};

/// Nodes of prescribed motion.
struct NodePins
{
    std::vector<Vec3> m_velocity;            ///< of a pinned node, as set by the user [m/s]
    std::vector<Vec3> m_position;            ///< wanted position of a moved or targeted node at the end of the step [m]
    std::vector<unsigned char> m_hasTarget;  ///< 1: kinematic by setNodeTarget
    std::vector<unsigned char> m_moved;      ///< 1: pinned and moved by the user since the last step
};

/// A collision of a body with another one, until they separate or rest: see Rebounds.
struct Impact
{
    const btCollisionObject* m_other = nullptr;
    int m_otherId = -1;          ///< broadphase id
    int m_component = 0;         ///< connected component of the body (TetMesh::nodeComponent)
    int m_otherComponent = -1;   ///< connected component of a soft other body; -1: rigid
    double m_restitution = 0;    ///< [-], in [0, 1]
    double m_passedOn = 0;       ///< separation speed that other patches add [m/s]
    int m_group = 0;             ///< number in common of impacts at once; 0: alone
    double m_push = 0;           ///< normal impulse of the step that m_restitution was found in [N s]
    Vec3 m_velocity;             ///< of the body relative to the other at the first contact, before it [m/s]
    double m_energy = 0;         ///< energy of both at the first contact [J]
    double m_loss = 0;           ///< kinetic energy that the normal impulses have taken from the rigid motions [J]
    double m_speed = 0;          ///< separation speed at the end of the last step [m/s]
    double m_gain = 0;           ///< largest increase of m_speed in a step [m/s]
    Vec3 m_point, m_normal;      ///< point of last contact [m]; unit normal from the other to the body
    Vec3 m_frame;                ///< velocity at the contact of an immovable side at the first contact [m/s]
    double m_time = 0;           ///< time since the first contact [s]
    double m_stopTime = 0;       ///< time from the first contact until contact ceased to drive the two apart [s]; 0: it
                                 ///< still does
    bool m_isHeld = false;       ///< an immovable object supports the body, which then counts as immovable
    bool m_otherIsHeld = false;  ///< an immovable object supports the other
    bool m_isNear = false;       ///< the two have contact points in this step
    bool m_isPressed = false;    ///< some of these have an impulse
    double m_impulse = 0;        ///< if pressed, the normal impulse of this step [N s]
    double m_speedBefore = 0;    ///< if pressed, the separation speed before this step [m/s]

    /// True if the two are between equal bodies and connected components.
    bool isOf(const Impact& b) const
    {
        return m_other == b.m_other && m_otherId == b.m_otherId && m_component == b.m_component &&
               m_otherComponent == b.m_otherComponent;
    }
};

/// Approach speed before the impact along its present normal [m/s], >= 0.
inline double approachOf(const Impact& impact)
{
    return std::max(0.0, -dot(impact.m_velocity, impact.m_normal));
}

/// Contact from step to step, as the last step left it.
struct ContactMemory
{
    std::vector<Vec3> m_predicted;         ///< contact impulses in the free motion [N s], one per node; empty: none
                                           ///< (ContactPrediction)
    std::vector<ContactPoint> m_contacts;  ///< contacts of the last step
    std::vector<ContactOrigin> m_origins;  ///< one per contact, ascending
    std::vector<SheetSide> m_sheetSides;   ///< of the last step, ascending
    std::vector<SolidPlace> m_solids;      ///< near the body in the last step, ascending
    std::vector<Vec3> m_positions;         ///< of the collision surface's vertices then [m]; empty: no solids
    std::vector<Impact> m_impacts;         ///< collisions that are not over
    NotedPlace m_place;                    ///< of the collision surface at the last soft contact search
};

/// Found at set-up in the btSoftBody, for comparison with its present state.
struct SetUpState
{
    std::uint64_t m_mark;                 ///< mark of the btSoftBody: see body_mark.h
    const btSoftBody::Node* m_firstNode;  ///< start of the array of nodes at the last check
    TopologyMarks m_topology;
    Vec3 m_restOrigin;  ///< position of node 0 of the rest shape, aligned with the body (RestMesh) [m]
    std::vector<btMatrix3x3> m_restMatrices;  ///< m_Dm_inverse of the elements at the last noteRestMatrices()
};

/// Settings of one body.
struct BodySettings
{
    double m_numericalDamping = 1;     ///< numerical damping of StepSettings that factors are made for
    double m_contactOffset = 0;        ///< [m]
    std::optional<Vec3> m_ownGravity;  ///< replaces the world info's in Bullet's deformable world [m/s2]; there,
                                       ///< m_cfg.drag replaces kDP
};

/// Objects whose bounds overlap the body's in this step.
struct BodyOverlaps
{
    std::mutex m_mutex;  ///< guards the lists while Bullet's threads collide
    std::vector<const btCollisionObject*> m_rigid;
    std::vector<const btSoftBody*> m_soft;  ///< FEM bodies; the body itself: self contact
};

/// Scratch of the contact search.
struct SearchScratch
{
    MeanMotion m_meanMotion;         ///< at the start of the step; valid if the body may have contact
    std::vector<double> m_nodeGap;   ///< one per vertex
    std::vector<Vec3> m_nodeNormal;  ///< one per vertex
    std::vector<double> m_edgeGap;   ///< one per surface edge: gap at its midpoint
    bool m_isInsideOut = false;      ///< some element is, or was in one of the last steps
};

/// A btSoftBody and its finite-element body.
struct FemSoftBody
{
    FemSoftBody(btSoftBody& softBody, std::shared_ptr<const BodyModel> model,
                std::shared_ptr<ComplianceCache> compliance);

    /// Sets a skin as collision surface, or the mesh's boundary (null). `compliance` is that of the nodes on which the
    /// surface depends. Discards contacts and impacts.
    void setSkin(std::shared_ptr<const CollisionSkin> skin, std::shared_ptr<ComplianceCache> compliance);

    /// Makes inner nodes ready for contact, which the compliance of a surface does not serve. Allocates at the first
    /// call with a compliance.
    void serveInnerNodes();

    /// Moves the skin to the present nodes. Call in every step after solveFreeMotion and before contact searches.
    void updateSkin();
    /// While `held` is true, the body does not move, and only the first of several searches updates the skin.
    void holdForSearches(bool held);

    /// Positions [m] and expected velocities [m/s] of the collision surface's vertices; without a skin, one per node.
    const std::vector<Vec3>& surfacePosition() const { return m_skin ? m_skinMotion.m_position : m_body.m_state.m_x; }
    const std::vector<Vec3>& surfaceVelocity() const;

    /// A point of a triangle of the collision surface as the solver's SurfacePoint.
    SurfacePoint pointOn(int body, const Triangle& vertices, const std::array<double, 3>& weights) const
    {
        return m_skin ? m_skin->pointOf(body, vertices, weights) : pointOf(body, vertices, weights);
    }

    /// Height of the element above a triangle of the mesh's boundary at rest [m]: a point as deep is inside the body.
    /// Infinite with a skin.
    double heightOn(int triangle) const
    {
        return m_ofMesh.m_height.empty() ? std::numeric_limits<double>::infinity() : m_ofMesh.m_height[triangle];
    }

    /// Nodes of elements that are not on the surface, ascending; none with a skin.
    const std::vector<int>& innerNodes() const { return m_ofMesh.m_inner; }

    /// Gravity that acts on the body [m/s2]; not checked.
    Vec3 gravity() const;

    btSoftBody* m_softBody;
    SetUpState m_setUp;
    Body m_body;
    std::shared_ptr<ComplianceCache> m_compliance;
    WrittenNodes m_written;
    NodePins m_pins;
    BodySettings m_settings;
    BodyOverlaps m_overlaps;
    HeldJoints m_joints;  ///< joints, attachments and springs of the body
    ContactMemory m_memory;
    SoftSurface m_surface;                        ///< collision surface; call its place() before soft contact searches
    std::shared_ptr<const CollisionSkin> m_skin;  ///< collision surface embedded in the mesh; null: the mesh's boundary
    SearchScratch m_search;

private:
    struct SkinMotion
    {
        std::vector<Vec3> m_position, m_velocity;    // see updateSkin
        bool m_isHeld = false, m_isUpdated = false;  // see holdForSearches
    };

    struct MeshMemory
    {
        std::shared_ptr<const ComplianceCache> m_servesInner;  // of all nodes, see serveInnerNodes; may be out of date
        std::vector<double> m_height;                          // see heightOn
        std::vector<int> m_inner;                              // see innerNodes
    };

    void sizeScratch();

    SkinMotion m_skinMotion;
    MeshMemory m_ofMesh;
};

/// True if a rest matrix has changed since noteRestMatrices(), as by initializeDmInverse or by scaling the body. Never
/// allocates.
bool restMatricesChanged(const FemSoftBody& fem);

/// Notes the present rest matrices for restMatricesChanged().
void noteRestMatrices(FemSoftBody& fem);

/// Replaces the rest shape of a body by one with the same nodes. Keeps its motion and joints; discards contacts, and
/// makes the mesh's boundary the collision surface.
void changeRestShape(FemSoftBody& fem, std::shared_ptr<const BodyModel> model,
                     std::shared_ptr<ComplianceCache> compliance);

/// Largest speed of a surface node relative to a velocity [m/s]; nodes with NaN are ignored.
double fastestNode(const Body& body, const Vec3& relativeTo);

/// Largest speed of a vertex of the collision surface relative to a velocity [m/s].
double fastestVertex(const FemSoftBody& fem, const Vec3& relativeTo);

}  // namespace bullet_fem
