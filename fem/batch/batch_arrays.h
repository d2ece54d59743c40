// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/factor/body_model.h"
#include "fem/batch/batch_algebra.h"
#include "fem/batch/batch_elements.h"
#include "fem/common/aligned_array.h"

namespace bullet_fem
{

/// True if bodies of this model can be solved side by side: a single connected component, not too large, all nodes in a
/// full factor, and elements that are not orthotropic.
bool canBeBatched(const BodyModel& model);

/// Scratch arrays for solving kBatchWidth bodies of one model side by side: interleaved, one lane per body.
class BatchArrays
{
public:
    /// For a model with canBeBatched(), which must outlive the arrays. Allocates.
    explicit BatchArrays(const BodyModel& model);

    const BodyModel& model() const { return m_model; }
    int nodeCount() const { return m_model.nodeCount(); }
    int elementCount() const;  ///< see BatchElements::m_count

    BatchElements elements() const;
    BatchMasses masses() const { return {nodeCount(), m_mass.get(), m_x.get()}; }
    BatchInertia inertia() const { return {nodeCount(), m_mass.get(), m_sums.get()}; }
    BatchNodeRotations nodeRotations();
    BatchWarp warp() const;

    AlignedDoubles m_x, m_v;                  ///< [node][3][body]: positions; velocities during the step [m], [m/s]
    AlignedDoubles m_rightSide, m_increment;  ///< [node][3][body]: b, before that forces [N s], [N]; dv [m/s]
    AlignedDoubles m_residual, m_direction, m_product;  ///< [node][3][body], conjugate gradients: r, p, A p
    AlignedDoubles m_mass;                              ///< [node][body] [kg]
    AlignedDoubles m_sums;                              ///< [node][2][3][body]; zero between the kernels that use it
    AlignedFloats m_rotation, m_warped;                 ///< see BatchElements
    AlignedFloats m_nodeRotation;                       ///< [node][9][body]
    AlignedFloats m_factorVector, m_factorScratch;      ///< arrays of PackedFactor::solveBatch()
    std::vector<unsigned> m_needsFallback;              ///< see BatchNodeRotations
    const std::vector<Vec3> m_zeros;

private:
    const BodyModel& m_model;
    std::vector<BatchCorners> m_corners;
    std::vector<int> m_position;  // position of each node in the factor
};

}  // namespace bullet_fem
