// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/batch/batch_arrays.h"

#include <algorithm>

#include "fem/elements/model_elements.h"
#include "fem/factor/rest_factor.h"

namespace bullet_fem
{
namespace
{

// Larger models would need more than about 50 MB of lanes.
constexpr int kMaxElements = 15000;

std::vector<BatchCorners> cornersOf(const BodyModel& model)
{
    constexpr int kVector = 3 * kBatchWidth;
    const std::vector<int>& elementAt = model.elements().m_lanes.m_element;
    std::vector<BatchCorners> corners(elementAt.size());
    for (std::size_t e = 0; e < corners.size(); ++e)
        for (int a = 0; a < 4; ++a)
        {
            const int node = model.mesh().tets()[elementAt[e]][a];
            corners[e].m_node[a] = node * kVector;
            corners[e].m_sum[a] = (2 * node + model.elements().m_nodes.m_parity[e][a]) * kVector;
        }
    return corners;
}

/// Zero-initialized, because kernels also process unused lanes.
template <class Real>
AlignedArray<Real> zeros(std::size_t valuesOfBody)
{
    const std::size_t count = kBatchWidth * valuesOfBody;
    AlignedArray<Real> values = allocateAligned<Real>(count);
    std::fill_n(values.get(), count, Real(0));
    return values;
}

}  // namespace

bool canBeBatched(const BodyModel& model)
{
    const TetMesh& mesh = model.mesh();
    return hasBatchKernels() && mesh.tetCount() <= kMaxElements && model.factorReport().m_path == FactorPath::full &&
           !model.shape().isOrthotropic() && mesh.componentCount() == 1 && mesh.looseCount() == 0 &&
           model.factor().freeNodeCount() == model.nodeCount();
}

BatchArrays::BatchArrays(const BodyModel& model)
    : m_zeros(model.nodeCount()), m_model(model), m_corners(cornersOf(model))
{
    const std::size_t nodes = nodeCount(), elements = elementCount();
    for (AlignedDoubles* vectors : {&m_x, &m_v, &m_rightSide, &m_increment, &m_residual, &m_direction, &m_product})
        *vectors = zeros<double>(3 * nodes);
    m_mass = zeros<double>(nodes);
    m_sums = zeros<double>(6 * nodes);
    m_rotation = zeros<float>(4 * elements);
    m_warped = zeros<float>(kWarpedRows * kLanes * blockCount(elementCount()));
    m_nodeRotation = zeros<float>(9 * nodes);
    m_needsFallback.resize(nodes);
    const RestFactor& factor = m_model.factor();
    m_factorVector = zeros<float>(factor.lower().vectorSize());
    m_factorScratch = allocateFloats(factor.lower().batchScratchSize());
    for (std::size_t i = 0; i < nodes; ++i) m_position.push_back(factor.position(static_cast<int>(i)));
}

int BatchArrays::elementCount() const
{
    const ElementBlocks<float>& blocks = m_model.elements().m_single;
    return blocks.hasPatches() ? kLanes * blocks.blockCount() : m_model.mesh().tetCount();
}

BatchElements BatchArrays::elements() const
{
    const ModelElements& elements = m_model.elements();
    return {&elements.m_single, m_corners.data(), elementCount(),   m_rotation.get(),
            m_warped.get(),     m_sums.get(),     &elements.m_lanes};
}

BatchNodeRotations BatchArrays::nodeRotations()
{
    return {&m_model.elements().m_nodes, m_rotation.get(), m_nodeRotation.get(), m_needsFallback.data()};
}

BatchWarp BatchArrays::warp() const
{
    return {nodeCount(), m_position.data(), m_nodeRotation.get(), m_factorVector.get()};
}

}  // namespace bullet_fem
