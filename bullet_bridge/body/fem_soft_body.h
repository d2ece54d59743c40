// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "LinearMath/btMatrix3x3.h"
#include "bullet_bridge/body/collision_skin.h"
#include "bullet_bridge/body/contact_patch.h"
#include "bullet_bridge/body/held_joint.h"
#include "bullet_bridge/body/model_library.h"
#include "bullet_bridge/body/topology_marks.h"
#include "bullet_bridge/geometry/surface/soft_surface.h"
#include "bullet_fem/fem/contact/contact_solver.h"

class btCollisionObject;

namespace bullet_fem
{

/// Where a contact point came from: how it is recognised in the next step.
struct ContactOrigin
{
    const btCollisionObject* m_object = nullptr;
    int m_objectId = 0;  ///< broadphase id; orders the contacts
    int m_leaf = 0;      ///< leaf of the object's shape
    int m_feature =
        0;  ///< vertex of what collides; then of every edge its middle and nearest point, then of every triangle
    int m_part = -1;      ///< Bullet's number of a mesh's part; -1: not a mesh
    int m_triangle = -1;  ///< and of a triangle in it

    bool operator<(const ContactOrigin& b) const
    {
        if (m_objectId != b.m_objectId) return m_objectId < b.m_objectId;
        return m_leaf != b.m_leaf ? m_leaf < b.m_leaf : m_feature < b.m_feature;
    }
};

/// Where a vertex of what collides was seen last near a concave shape, whose sheets have two sides.
struct SheetSide
{
    int m_objectId = 0, m_leaf = 0, m_node = 0;  ///< as in ContactOrigin
    Vec3 m_position;                             ///< in the leaf's frame [m]
    Vec3 m_safe;                                 ///< likewise, on the right side of all sheets [m]

    bool operator<(const SheetSide& b) const
    {
        if (m_objectId != b.m_objectId) return m_objectId < b.m_objectId;
        return m_leaf != b.m_leaf ? m_leaf < b.m_leaf : m_node < b.m_node;
    }
};

/// What was last written to the btSoftBody's nodes: a component that differs was written by the user since.
struct WrittenNodes
{
    std::vector<btVector3> m_x, m_v;
    std::vector<btScalar> m_inverseMass;
};

/// Nodes whose motion is prescribed.
struct NodePins
{
    std::vector<Vec3> m_velocity;            ///< that the user gave a pinned node [m/s]
    std::vector<Vec3> m_position;            ///< where a moved or targeted node shall be at the end of the step [m]
    std::vector<unsigned char> m_hasTarget;  ///< 1: kinematic by setNodeTarget
    std::vector<unsigned char> m_moved;      ///< 1: pinned and moved by the user since the last step
};

/// Something that a body has run into, until they part or rest: see Rebounds.
struct Impact
{
    const btCollisionObject* m_other = nullptr;
    int m_otherId = -1;          ///< broadphase id
    int m_piece = 0;             ///< of the body that has hit it (TetMesh::nodeComponent)
    int m_otherPiece = -1;       ///< likewise, if it is soft; -1: rigid
    double m_restitution = 0;    ///< [-], in [0, 1]
    double m_approach = 0;       ///< speed at which they met [m/s]
    double m_energy = 0;         ///< of both as they met [J]
    double m_speed = 0;          ///< at which they part, as the last step ended [m/s]
    double m_gain = 0;           ///< the most that a step has added to it [m/s]
    Vec3 m_point, m_normal;      ///< where they touched last [m], and from the other to the body [-]
    Vec3 m_frame;                ///< velocity there of the one that cannot be moved, as they met [m/s]
    double m_time = 0;           ///< since they met [s]
    double m_stopTime = 0;       ///< since they met until nothing drove them apart any more; 0: it does [s]
    bool m_isHeld = false;       ///< the body lies against something immovable, and counts as such
    bool m_otherIsHeld = false;  ///< likewise
    bool m_isNear = false;       ///< in this step they have contact points
    bool m_isPressed = false;    ///< and impulses

    bool isOf(const Impact& b) const
    {
        return m_other == b.m_other && m_otherId == b.m_otherId && m_piece == b.m_piece &&
               m_otherPiece == b.m_otherPiece;
    }
};

/// A btSoftBody and the finite-element body that moves it.
struct FemSoftBody
{
    FemSoftBody(btSoftBody& softBody, std::shared_ptr<const BodyModel> model,
                std::shared_ptr<ComplianceCache> compliance);

    /// Makes a skin what collides, or the mesh's boundary again (null). `compliance` serves the nodes that this
    /// depends on; contacts begin anew.
    void setSkin(std::shared_ptr<const CollisionSkin> skin, std::shared_ptr<ComplianceCache> compliance);

    /// Takes a skin to where the nodes are: in every step, after solveFreeMotion, before contacts are searched.
    void updateSkin();
    /// While it is held nothing moves the body: of several searches one updates the skin.
    void holdForSearches(bool held);

    /// Of the vertices of what collides, which are the nodes if there is no skin [m], [m/s].
    const std::vector<Vec3>& surfacePosition() const { return m_skin ? m_skinPosition : m_body.m_state.m_x; }
    const std::vector<Vec3>& surfaceVelocity() const;

    /// A point of a triangle of it, for the solver.
    SurfacePoint pointOn(int body, const Triangle& vertices, const std::array<double, 3>& weights) const
    {
        return m_skin ? m_skin->pointOf(body, vertices, weights) : pointOf(body, vertices, weights);
    }

    btSoftBody* m_softBody;
    const btSoftBody::Node* m_firstNode;  ///< where the array of its nodes begins, as seen last
    std::uint64_t m_mark;                 ///< on the btSoftBody: see body_mark.h
    TopologyMarks m_topology;             ///< as it became FEM
    Body m_body;
    Vec3 m_restOrigin;  ///< node 0 of the rest shape, laid over the body as it became FEM (RestMesh) [m]
    std::vector<btMatrix3x3> m_restMatrices;  ///< m_Dm_inverse of the elements, as seen last
    std::shared_ptr<ComplianceCache> m_compliance;
    WrittenNodes m_written;
    NodePins m_pins;
    double m_numericalDamping = 1;  ///< StepSettings has it: of the steps that factors are made for
    double m_contactOffset = 0;     ///< [m]
    bool m_hasOwnGravity = false;
    Vec3 m_ownGravity;  ///< in Bullet's deformable world: in place of the world info's [m/s2]; and m_cfg.drag of kDP

    /// What it falls with [m/s2]; not checked.
    Vec3 gravity() const;

    std::mutex m_touchingMutex;                        ///< guards m_touching while Bullet's threads collide
    std::vector<const btCollisionObject*> m_touching;  ///< overlapping rigid objects of this step

    std::vector<const btSoftBody*> m_touchingSoft;  ///< overlapping FEM bodies of this step; itself: self contact

    HeldJoints m_joints;  ///< what holds the body

    std::vector<Vec3> m_predicted;  ///< impulses of contact in the free motion [N s], one a node; empty: SteadyBodies

    MeanMotion m_meanMotion;                           ///< as the step begins; of a body that may touch something
    std::vector<ContactPoint> m_contacts;              ///< of the last step
    std::vector<ContactOrigin> m_origins;              ///< one a contact, ascending
    std::vector<SheetSide> m_sheetSides;               ///< of the last step, ascending
    std::vector<Impact> m_impacts;                     ///< that are not over
    SoftSurface m_surface;                             ///< what collides; update() it before soft bodies are searched
    std::shared_ptr<const CollisionSkin> m_skin;       ///< what collides follows the mesh; null: it is its boundary
    std::vector<Vec3> m_skinPosition, m_skinVelocity;  ///< see updateSkin
    std::vector<double> m_nodeGap;                     ///< scratch of the contact search, one a vertex
    std::vector<Vec3> m_nodeNormal;                    ///< likewise
    std::vector<double> m_edgeGap;                     ///< likewise, one a surface edge: at its middle

private:
    void sizeScratch();

    bool m_isHeldForSearches = false, m_isSkinUpdated = false;
};

/// True if the user called initializeDmInverse, or scaled the body, since noteRestMatrices, and that changed a matrix.
/// Never allocates.
bool restMatricesChanged(const FemSoftBody& fem);
void noteRestMatrices(FemSoftBody& fem);

/// Gives a body another rest shape of the same nodes, and keeps its motion and what holds it; contacts begin anew, with
/// the boundary.
void changeRestShape(FemSoftBody& fem, std::shared_ptr<const BodyModel> model,
                     std::shared_ptr<ComplianceCache> compliance);

/// Largest speed of a surface node relative to a velocity [m/s]; NaN counts as none.
double fastestNode(const Body& body, const Vec3& relativeTo);

/// The same for the vertices of what collides.
double fastestVertex(const FemSoftBody& fem, const Vec3& relativeTo);

}  // namespace bullet_fem
