// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

/// The elements of a model, packed for the kernels in both precisions.
struct ModelElements
{
    explicit ModelElements(const RestShape& shape)
        : m_lanes(shape), m_single(shape, m_lanes), m_double(shape, m_lanes), m_nodes(shape, m_lanes)
    {
    }

    int blockCount() const { return m_single.blockCount(); }
    template <class Real>
    const ElementBlocks<Real>& blocks() const
    {
        if constexpr (sizeof(Real) == sizeof(float))
            return m_single;
        else
            return m_double;
    }

    ElementLanes m_lanes;
    ElementBlocks<float> m_single;
    ElementBlocks<double> m_double;
    NodeCorners m_nodes;
};

}  // namespace bullet_fem
