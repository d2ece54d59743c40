// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"

class btCollisionObject;

/// What holds a FEM body besides contact.
enum class btFemHold
{
    anchor,            ///< an element of m_anchors
    deformableAnchor,  ///< of m_deformableAnchors
    attachment,        ///< made by btFemSoftBodySolver::attachNodes or attachNodeToTet
    linearJoint,       ///< an LJoint of m_joints
    angularJoint,      ///< an AJoint of m_joints
    spring             ///< made by btFemSoftBodySolver::addSpring
};

/// An anchor, attachment or joint in the last step.
///
/// Anchors work as on Bullet's own soft bodies, with these differences. The object must be in the soft body's world:
/// when it leaves, its anchors are removed from m_anchors (BT_FEM_LOST_ANCHOR), and so are joints to it. An influence
/// i < 1 adds (1 - i) / i times the compliance of what is joined. m_battach says of nodes that were anchored whether
/// they still are. A multibody's link leads the node but feels nothing of it.
struct btFemAnchorReport
{
    btFemHold m_kind = btFemHold::anchor;         ///< what it is
    int m_node = -1;                              ///< that is held; -1 where it is a cluster or a point between nodes
    int m_attachment = 0;                         ///< its handle, or that of a spring (negative: of a mouse picking
                                                  ///< force); 0 for other kinds
    const void* m_joint = nullptr;                ///< the element of m_joints; null for other kinds
    const btCollisionObject* m_object = nullptr;  ///< at the other end; null: the world
    btVector3 m_point{0, 0, 0};                   ///< where the body is held, as the step began [m]
    btVector3 m_impulse{0, 0, 0};  ///< on the body [N s], of angular joints [N m s]; the other end got the opposite
    btScalar m_error = 0;          ///< distance [m] or angle [rad] between the ends as the step began, >= 0
};
