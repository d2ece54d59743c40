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

/// What holds a node or a cluster of a FEM body in a step. Pointers tell who it is; none of them may be followed.
struct HeldJoint
{
    enum class Kind
    {
        anchor,            ///< of m_anchors
        deformableAnchor,  ///< of m_deformableAnchors
        attachment,        ///< to another soft body's surface
        linearJoint,       ///< of a cluster
        angularJoint,      ///< of a cluster
        spring             ///< to a place in the world
    };

    Kind m_kind = Kind::anchor;
    int m_node = -1;                              ///< of anchors and attachments
    const btCollisionObject* m_object = nullptr;  ///< other end; null: the world
    int m_objectId = -1;                          ///< its broadphase id
    const void* m_source = nullptr;               ///< of cluster joints: what the user made
    int m_id = 0;                                 ///< of attachments and springs: their handle
    Vec3 m_point;                                 ///< of this body, where it is held, as the step began [m]
    double m_error = 0;                           ///< distance [m] or angle [rad] between the ends as the step began
    Vec3 m_impulse;                               ///< on this body [N s], of angular joints [N m s]
    int m_row = -1;                               ///< index of its Joint in the step's problem
    bool m_isEndB = false;                        ///< this body is end b of that

    /// The same hold as in another step.
    bool continues(const HeldJoint& before) const
    {
        return m_kind == before.m_kind && m_node == before.m_node && m_object == before.m_object &&
               m_source == before.m_source && m_id == before.m_id;
    }
};

/// The ends of a cluster joint while Bullet's own cluster solver must not see them.
struct HiddenJoint
{
    btSoftBody::Joint* m_joint = nullptr;
    btSoftBody::Body m_bodies[2];
    btSoftBody::AJoint::IControl* m_control = nullptr;  // of an angular one
};

/// Ties a node to a point of another FEM body.
struct NodeAttachment
{
    int m_id = 0;                                    ///< handle
    int m_node = 0;                                  ///< of the body that has it
    const btSoftBody* m_other = nullptr;             ///< the body with the point; never followed
    std::uint64_t m_otherMark = 0;                   ///< see body_mark.h: its address may come to another body
    std::array<int, 4> m_otherNodes = {};            ///< nodes that carry the point; unused ones repeat the first
    std::array<double, 4> m_weights = {1, 0, 0, 0};  ///< barycentric [-], sum 1
    double m_area = 0;                               ///< of a weld, whose handle it has: that it holds [m2]; else 0
    double m_compliance = 0;                         ///< of an elastic weld [m/N]; 0: rigid
};

/// Faces of two bodies that are held together by attachments with its handle, until they break: see welds.h.
struct Weld
{
    int m_id = 0;                             ///< handle
    const btSoftBody* m_other = nullptr;      ///< never followed
    std::vector<std::array<int, 3>> m_faces;  ///< that were welded, nodes of the body that has it, seen from outside
    double m_breakForce = 0;                  ///< of all of it [N], > 0; may be infinite, as the next
    double m_breakStress = 0;                 ///< of a node, tension and shear [Pa], > 0
    double m_breakStretch = 0;                ///< distance of a node from its partner [m], > 0
};

/// Ties a node of a cloth (see isCloth) to a point of the body that has it.
struct ClothAttachment
{
    int m_id = 0;                                    ///< handle
    btSoftBody* m_cloth = nullptr;                   ///< followed only while the world has it
    int m_clothId = -1;                              ///< its broadphase id; -1: it was in no world yet
    int m_clothNode = 0;                             ///< of the cloth
    std::array<int, 4> m_nodes = {};                 ///< that carry the point; unused ones repeat the first
    std::array<double, 4> m_weights = {1, 0, 0, 0};  ///< barycentric [-], sum 1
};

/// Pulls a point between nodes to a place in the world.
struct NodeSpring
{
    int m_id = 0;                                 ///< handle
    std::array<int, 3> m_nodes = {};              ///< that carry the point
    std::array<double, 3> m_weights = {1, 0, 0};  ///< barycentric [-], sum 1
    Vec3 m_target;                                ///< [m]
    double m_stiffness = 0;                       ///< [N/m], >= 0
    double m_damping = 0;                         ///< [N s/m], >= 0
    double m_maxForce = 0;                        ///< [N], >= 0; 0: no limit
};

/// All that holds a FEM body, from step to step.
struct HeldJoints
{
    std::vector<HeldJoint> m_now;     ///< of the last step
    std::vector<HeldJoint> m_before;  ///< of the one before
    std::vector<HiddenJoint> m_hidden;
    std::vector<NodeAttachment> m_attachments;
    std::vector<Weld> m_welds;              ///< ascending by handle
    int m_cluster = -1;                     ///< of bodies that hang together by welds, in this step; -1: none
    std::vector<unsigned char> m_isWelded;  ///< per node: it has a weld's tie, in this step; empty: none has
    std::vector<ClothAttachment> m_clothAttachments;
    bool m_clothIsLost = false;  ///< one of these was removed in this step
    std::vector<NodeSpring> m_springs;
    int m_lastId = 0;  ///< handle that was given last
};

}  // namespace bullet_fem
