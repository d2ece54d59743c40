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
    std::vector<NodeSpring> m_springs;
    int m_lastId = 0;  ///< handle that was given last
};

}  // namespace bullet_fem
