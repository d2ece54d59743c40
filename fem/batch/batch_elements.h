// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/body/batch_width.h"
#include "fem/elements/element_pass.h"

namespace bullet_fem
{

/// Where the vectors of an element's nodes begin in [node][3][body], and what its corners add to in [node][2][3][body]:
/// one of two sums, by NodeCorners::m_parity.
struct BatchCorners
{
    std::int32_t m_node[4], m_sum[4];
};

/// The elements of kBatchWidth bodies, and what their kernels hand on. All arrays are aligned to 64 bytes, and
/// interleaved: the last index is the body.
struct BatchElements
{
    const ElementBlocks<float>* m_rest;
    const BatchCorners* m_corners;  ///< one an element
    int m_count;                    ///< elements; with patches, lanes of m_rest
    float* m_rotation;              ///< [element][x, y, z, w][body]
    float* m_warped;                ///< [element][kWarpedRows][body], as in WarpedBlock
    double* m_sums;                 ///< [node][2][3][body]: of what corners hold
    const ElementLanes* m_lanes;    ///< where elements stand, "element" e being that of lane e
};

/// ElementPass over them.
struct BatchElementPass
{
    const double* m_x;  ///< [node][3][body] [m]
    const double* m_v;  ///< likewise [m/s]
    double m_damping, m_tensionFactor;
    const Quaternion* m_rotationBefore[kBatchWidth];  ///< of every body's elements, in the last step
    Quaternion* m_rotation[kBatchWidth];              ///< out; may be the same; null: of no body
    WarpedBlock<float>* m_warped[kBatchWidth];        ///< out; null likewise
};

/// False on processors without vectors: then the functions here do nothing.
bool hasBatchKernels();

/// Every body gets the bits that runElementPass gives it; corner forces are added to m_sums.
void runElementPass(const BatchElements& elements, const BatchElementPass& pass);

/// ElementProduct with p: [node][3][body]; adds to m_sums likewise.
void runElementProduct(const BatchElements& elements, double stiffnessFactor, const double* p);

}  // namespace bullet_fem
