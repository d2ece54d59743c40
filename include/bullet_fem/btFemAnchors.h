// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"

class btCollisionObject;

/// Kinds of constraints on a FEM body besides contact.
enum class btFemHold
{
    anchor,            ///< an element of m_anchors
    deformableAnchor,  ///< an element of m_deformableAnchors
    attachment,        ///< made by btFemSoftBodySolver::attachNodes or attachNodeToTet
    linearJoint,       ///< an LJoint of m_joints
    angularJoint,      ///< an AJoint of m_joints
    spring             ///< made by btFemSoftBodySolver::addSpring
};

/// The impulse and error of an anchor, attachment, joint or spring in the last step.
///
/// Anchors work as on Bullet's own soft bodies, with these differences. The object must be in the soft body's world:
/// when it leaves, its anchors are removed from m_anchors (BT_FEM_LOST_ANCHOR), and so are joints to it. An influence i
/// < 1 adds (1 - i) / i times the compliance of the joined bodies. m_battach tells whether a node is still anchored. A
/// multibody's link leads the node without receiving its reaction.
struct btFemAnchorReport
{
    btFemHold m_kind = btFemHold::anchor;  ///< kind of the constraint
    int m_node = -1;                       ///< node that is held; -1 for a cluster or a point between nodes
    /// handle of an attachment or spring (negative for a mouse picking force); 0 for other kinds
    int m_attachment = 0;
    const void* m_joint = nullptr;                ///< element of m_joints; null for other kinds
    const btCollisionObject* m_object = nullptr;  ///< the other object; null: the world
    btVector3 m_point{0, 0, 0};                   ///< point of the body that is held, at the beginning of the step [m]
    /// impulse on the body [N s], for angular joints [N m s]; the other side gets the opposite
    btVector3 m_impulse{0, 0, 0};
    btScalar m_error = 0;  ///< distance [m] or angle [rad] between the two sides at the beginning of the step, >= 0
};
