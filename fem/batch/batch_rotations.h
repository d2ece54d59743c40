// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Rotations of the nodes of bodies side by side, and vectors turned by them: NodeRotations and what
// WarpedPreconditioner does around the solve, with the same bits.
#pragma once

#include "fem/batch/batch_algebra.h"
#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

/// Rotations of nodes from those of their elements.
struct BatchNodeRotations
{
    const NodeCorners* m_nodes;
    const float* m_elements;  ///< [element][x, y, z, w][body]
    float* m_out;             ///< [node][9][body], row-major
    unsigned* m_doubtful;     ///< out, per node: bit b of a body b that is to have carefulAverage()
};
void averageRotations(const BatchNodeRotations& rotations);

/// The factor's vectors of bodies side by side, [position][3][body], and the rotations of their nodes.
struct BatchWarp
{
    int m_nodes;
    const int* m_position;    ///< of every node in the factor
    const float* m_rotation;  ///< [node][9][body]
    float* m_factorVector;
};

/// The factor's vector <- R^T in, scaled to order one; returns what it was divided by.
PerBatch rotateIn(const BatchWarp& warp, ConstBodyVectors in);

/// out <- scale R (the factor's vector); returns in . out.
PerBatch rotateOut(const BatchWarp& warp, const PerBatch& scale, ConstBodyVectors in, BodyVectors out);

}  // namespace bullet_fem
