// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Node rotations of bodies side by side, and rotation of vectors by them: NodeRotations and the rotations in
// WarpedPreconditioner, with bitwise equal results.
#pragma once

#include "fem/batch/batch_algebra.h"
#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

/// Averages element rotations to node rotations.
struct BatchNodeRotations
{
    const NodeCorners* m_nodes;
    const float* m_elements;    ///< [element][x, y, z, w][body]
    float* m_out;               ///< [node][9][body], row-major
    unsigned* m_needsFallback;  ///< output, per node: bit b is set if body b needs robustAverage()
};
void averageRotations(const BatchNodeRotations& rotations);

/// The factor's vectors of bodies side by side, [position][3][body], and their node rotations.
struct BatchWarp
{
    int m_nodes;
    const int* m_position;    ///< position of each node in the factor
    const float* m_rotation;  ///< [node][9][body]
    float* m_factorVector;
};

/// Factor vector <- R^T in / scale, with `scale` chosen to bring it to order one; returns the scale.
PerBatch rotateIn(const BatchWarp& warp, ConstBodyVectors in);

/// out <- scale R (factor vector); returns in . out.
PerBatch rotateOut(const BatchWarp& warp, const PerBatch& scale, ConstBodyVectors in, BodyVectors out);

}  // namespace bullet_fem
