// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// A joint that holds a node or a cluster of a FEM body in a step. Its pointers identify objects and must not be
/// followed.
struct HeldJoint
{
    enum class Kind
    {
        anchor,            ///< from btSoftBody::m_anchors
        deformableAnchor,  ///< from btSoftBody::m_deformableAnchors
        attachment,        ///< to the surface of another soft body, or of a cloth node to this body
        linearJoint,       ///< linear joint of a cluster
        angularJoint,      ///< angular joint of a cluster
        spring             ///< to a point in the world
    };

    Kind m_kind = Kind::anchor;
    int m_node = -1;                              ///< node of anchors and attachments
    const btCollisionObject* m_object = nullptr;  ///< other side; null: the world
    int m_objectId = -1;                          ///< its broadphase id
    const void* m_source = nullptr;               ///< of cluster joints: the user's btSoftBody::Joint
    int m_id = 0;                                 ///< of attachments and springs: handle
    Vec3 m_point;                                 ///< held point of this body as the step began [m]
    double m_error = 0;                           ///< distance [m] or angle [rad] between the sides as the step began
    Vec3 m_impulse;                               ///< on this body [N s]; of angular joints [N m s]
    int m_row = -1;                               ///< index of its Joint in the step's problem
    bool m_isEndB = false;                        ///< this body is side b of that Joint

    /// True if this is the joint `before` of an earlier step.
    bool continues(const HeldJoint& before) const
    {
        return m_kind == before.m_kind && m_node == before.m_node && m_object == before.m_object &&
               m_source == before.m_source && m_id == before.m_id;
    }
};

/// The bodies of a cluster joint while they are hidden from Bullet's own cluster solver.
struct HiddenJoint
{
    btSoftBody::Joint* m_joint = nullptr;
    btSoftBody::Body m_bodies[2];
    btSoftBody::AJoint::IControl* m_control = nullptr;  // of an angular joint
};

/// Ties a node to a point of another FEM body.
struct NodeAttachment
{
    int m_id = 0;                          ///< handle
    int m_node = 0;                        ///< of the body with this attachment
    const btSoftBody* m_other = nullptr;   ///< the body with the point; must not be followed
    std::uint64_t m_otherMark = 0;         ///< mark of the other body (body_mark.h), as its address may be reused
    std::array<int, 4> m_otherNodes = {};  ///< nodes that carry the point; unused ones repeat the first
    std::array<double, 4> m_weights = {1, 0, 0, 0};  ///< barycentric [-], sum 1
    double m_area = 0;        ///< area that a weld's attachment represents, if m_id is a weld's handle [m2]; else 0
    double m_compliance = 0;  ///< of an elastic weld [m/N]; 0: rigid
};

/// Welded faces of two bodies, held together by attachments with its handle until they break: see welds.h.
struct Weld
{
    int m_id = 0;                             ///< handle
    const btSoftBody* m_other = nullptr;      ///< must not be followed
    std::vector<std::array<int, 3>> m_faces;  ///< welded faces, nodes of the body with the weld, oriented outward
    double m_breakForce = 0;                  ///< of the whole weld [N], > 0; may be infinite, as the next
    double m_breakStress = 0;                 ///< of a node, in tension or shear [Pa], > 0
    double m_breakStretch = 0;                ///< distance between a node and its partner [m], > 0
};

/// Ties a node of a cloth (see isCloth) to a point of the body with this attachment.
struct ClothAttachment
{
    int m_id = 0;                                    ///< handle
    btSoftBody* m_cloth = nullptr;                   ///< followed only while the world contains it
    int m_clothId = -1;                              ///< broadphase id of the cloth; -1: not in a world yet
    int m_clothNode = 0;                             ///< of the cloth
    std::array<int, 4> m_nodes = {};                 ///< nodes that carry the point; unused ones repeat the first
    std::array<double, 4> m_weights = {1, 0, 0, 0};  ///< barycentric [-], sum 1
};

/// A spring between a point of the body and a point in the world.
struct NodeSpring
{
    int m_id = 0;                                 ///< handle
    std::array<int, 3> m_nodes = {};              ///< nodes that carry the point
    std::array<double, 3> m_weights = {1, 0, 0};  ///< barycentric [-], sum 1
    Vec3 m_target;                                ///< [m]
    double m_stiffness = 0;                       ///< [N/m], >= 0
    double m_damping = 0;                         ///< [N s/m], >= 0
    double m_maxForce = 0;                        ///< [N], >= 0; 0: no limit
};

/// All joints, attachments, welds and springs of a FEM body, kept from step to step.
struct HeldJoints
{
    std::vector<HeldJoint> m_now;     ///< joints of the last step
    std::vector<HeldJoint> m_before;  ///< joints of the step before that
    std::vector<HiddenJoint> m_hidden;
    std::vector<NodeAttachment> m_attachments;
    std::vector<Weld> m_welds;              ///< ascending by handle
    int m_cluster = -1;                     ///< group of bodies connected by welds in this step; -1: none
    std::vector<unsigned char> m_isWelded;  ///< per node: a weld's attachment holds it in this step; empty: none
    std::vector<ClothAttachment> m_clothAttachments;
    bool m_clothIsLost = false;  ///< a cloth attachment was removed in this step
    std::vector<NodeSpring> m_springs;
    int m_lastId = 0;  ///< last handle given
};

}  // namespace bullet_fem
