// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"

/// Force and moment by which supports, or anchors and joints, hold a FEM body: the mean of the last step, impulse over
/// h, in the world's axes. They act on the body; what holds it feels the opposite.
///
/// Nodes are held that are pinned (m_im = 0) or led (setNodeTarget). Their reactions come from momentum balance,
/// exactly but for rounding: for every connected part of a body
///
///     reactions + gravity and other loads + contacts + anchors and joints = change of momentum / h
///
/// and the same with moments about any point, where a reaction and a node's load act in the middle of the node's way,
/// (m_q + m_x) / 2, a contact at m_point and an anchor where the step began. Held nodes have momenta, too: by the mass
/// that they would have unpinned, their share of the body's volume times its density. kDP, drag and damping by mass
/// count as loads. Forces at a single node have no moment about it, and forces on a line none about that, so that there
/// the moments are as exact as the step (docs/theory.md, Reactions).
struct btFemReaction
{
    btVector3 m_force{0, 0, 0};   ///< on the body [N]
    btVector3 m_moment{0, 0, 0};  ///< on the body, about the point that was asked for [N m]
    int m_count = 0;              ///< held nodes, or anchors and joints, that this sums up; 0: there are none, the body
                                  ///< is not FEM, or its last step tells nothing
};
