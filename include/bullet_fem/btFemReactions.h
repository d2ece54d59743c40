// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"

/// Force and moment of supports, or of anchors and joints, on a FEM body: the mean over the last step, impulse over h,
/// in world axes. The opposite acts on the support.
///
/// Held nodes are those that are pinned (m_im = 0) or led (setNodeTarget). Their reactions follow from momentum
/// balance, exact to rounding; for every connected component of a body
///
///     reactions + gravity and other loads + contacts + anchors and joints = change of momentum / h
///
/// and correspondingly for moments about any point, where a reaction and a node's load act at the midpoint of the
/// node's motion, (m_q + m_x) / 2, a contact at m_point, and an anchor at its point at the beginning of the step. Held
/// nodes have momentum, too, by their mass without the pin: their share of the body's volume times its density. kDP,
/// drag and mass damping count as loads. Forces at a single node have no moment about it, and forces on a line none
/// about the line; these moments are only as exact as the solve of the step (docs/theory.md, Reactions).
struct btFemReaction
{
    btVector3 m_force{0, 0, 0};   ///< force on the body [N]
    btVector3 m_moment{0, 0, 0};  ///< moment on the body about the given point [N m]
    /// number of held nodes, or of anchors and joints, in the sum; 0 if there are none, the body is not FEM, or
    /// reactions of its last step are unknown
    int m_count = 0;
};
