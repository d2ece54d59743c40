// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/elements/element_pass.h"
#include "fem/elements/node_rotations.h"
#include "fem/elements/orthotropic_elements.h"

namespace bullet_fem
{

/// Output arrays of one body's element kernels in a step, in one precision.
template <class Real>
struct ElementScratch
{
    void grow(int blocks)
    {
        m_corners.resize(blocks);
        m_warped.resize(blocks);
    }

    std::vector<CornerBlock<Real>> m_corners;
    std::vector<WarpedBlock<Real>> m_warped;
    std::vector<StressBlock<Real>> m_initialStress;  ///< empty without initial stress
    std::vector<TangentBlock<Real>> m_tangent;       ///< empty without laws that vary
    std::vector<StrainBlock<Real>> m_strain;         ///< empty until inelastic strains are needed
    std::vector<StretchBlock<Real>> m_stretches;     ///< empty but for orthotropic and assumed elements
};

/// Number of steps that stay prepared for impulses after one that had some: preparing late costs as much as preparing
/// about six steps in advance.
constexpr int kStepsReadyForImpulses = 16;

/// The vectors of the element kernels. The double-precision half grows on first use.
struct ElementWork
{
    explicit ElementWork(int nodes, int blocks) : m_x(nodes), m_v(nodes), m_scaledMass(nodes), m_nodeRotation(nodes)
    {
        m_single.grow(blocks);
    }

    template <class Real>
    ElementScratch<Real>& scratch()
    {
        if constexpr (sizeof(Real) == sizeof(float))
            return m_single;
        else
            return m_double;
    }

    bool m_isDouble = false;          ///< precision of this step
    bool m_isComplete = true;         ///< false: m_warped and m_scaledMass are outdated
    int m_stepsReadyForImpulses = 0;  ///< number of further steps to prepare for impulses
    double m_stiffnessFactor = 0;     ///< coefficient of K' in this step's A, c h^2 + h beta [s2]
    ElementScratch<float> m_single;
    ElementScratch<double> m_double;
    std::vector<PaddedVec3> m_x, m_v;          ///< positions and velocities; later m_x is the argument of A
    std::vector<double> m_scaledMass;          ///< (1 + h alpha) m_i [kg]
    std::vector<NodeRotation> m_nodeRotation;  ///< rotation of every node in the preconditioner
};

}  // namespace bullet_fem
