// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/body/batch_width.h"
#include "fem/elements/element_pass.h"

namespace bullet_fem
{

/// Offsets of an element's node vectors in [node][3][body], and of the sums its corners add to in [node][2][3][body]:
/// one of two sums a node, by NodeCorners::m_parity.
struct BatchCorners
{
    std::int32_t m_node[4], m_sum[4];
};

/// Element data of kBatchWidth bodies and the output of their kernels. All arrays are aligned to 64 bytes and
/// interleaved: the last index is the body.
struct BatchElements
{
    const ElementBlocks<float>* m_rest;
    const BatchCorners* m_corners;  ///< one per element
    int m_count;                    ///< elements; with patches, number of lanes of m_rest
    float* m_rotation;              ///< [element][x, y, z, w][body]
    float* m_warped;                ///< [element][kWarpedRows][body], as in WarpedBlock
    double* m_sums;                 ///< [node][2][3][body]: sums of the corners' contributions
    const ElementLanes* m_lanes;    ///< order of the elements: "element" e is that of lane e
};

/// Arguments of ElementPass for bodies side by side.
struct BatchElementPass
{
    const double* m_x;  ///< [node][3][body] [m]
    const double* m_v;  ///< [node][3][body] [m/s]
    double m_damping, m_tensionFactor;
    const Quaternion* m_rotationBefore[kBatchWidth];  ///< rotations of every body's elements in the last step
    Quaternion* m_rotation[kBatchWidth];        ///< output; may alias m_rotationBefore; null: no output for this body
    WarpedBlock<float>* m_warped[kBatchWidth];  ///< output; null: no output for this body
};

/// False on processors without vectors; the other functions do nothing then.
bool hasBatchKernels();

/// Element pass of all bodies, each bitwise equal to runElementPass() of the body alone; adds corner forces to m_sums.
void runElementPass(const BatchElements& elements, const BatchElementPass& pass);

/// ElementProduct of all bodies with p: [node][3][body]; adds the corners' contributions to m_sums.
void runElementProduct(const BatchElements& elements, double stiffnessFactor, const double* p);

}  // namespace bullet_fem
