// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/kernels/bent_beam.h"

#include <algorithm>

#include "benchmarks/beam/fem_beam.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/body/step_scratch.h"
#include "fem/elements/model_elements.h"
#include "fem/factor/rest_factor.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{
namespace
{

BeamCase softBeam(int tets)
{
    Material material;
    material.m_stiffnessDamping = 0.01;
    return makeBeamCase(beamCells(tets), material);
}

}  // namespace

BentBeam::BentBeam(int tets) : m_body(makeBeamModel(softBeam(tets)))
{
    const BeamCase beam = softBeam(tets);
    m_settings.m_step = beam.m_step;
    for (std::size_t i = 0; i < beam.m_positions.size(); ++i)
        m_body.m_loads.m_force[i] = m_body.m_state.m_mass[i] * beam.m_gravity;
    for (int k = 0; k < 30; ++k) step(m_body, m_settings);
    m_lastRotation = m_body.m_state.m_elementRotation;
    m_in = m_body.m_state.m_v;
    m_out = m_in;

    const PackedFactor& factor = model().factor().lower();
    m_vector = allocateFloats(factor.vectorSize());
    m_scratch = allocateFloats(factor.scratchSize());
    m_lanes = allocateFloats(static_cast<std::size_t>(factor.size()) * kPanelLanes);
    m_lanesScratch = allocateFloats(factor.laneScratchSize());
    prepareSystem();
}

void BentBeam::passOverElements()
{
    const ModelElements& elements = model().elements();
    ElementWork& work = m_body.m_workspace.scratch().m_elements;
    const double h = m_settings.m_step, beta = model().shape().m_material.m_stiffnessDamping;
    ElementPass<float> pass;
    pass.m_elements = &elements.m_single;
    pass.m_x = work.m_x.data();
    pass.m_v = work.m_v.data();
    pass.m_damping = h + beta;
    pass.m_tensionFactor = h * h;
    pass.m_rotation = m_body.m_state.m_elementRotation.data();
    pass.m_force = work.m_single.m_corners.data();
    pass.m_warped = work.m_single.m_warped.data();
    runElementPass(pass, {0, elements.blockCount()});
}

void BentBeam::prepareSystem()
{
    prepareWarpedSystem(m_body, m_settings, m_body.m_workspace.scratch().m_kickPosition, m_body.m_state.m_v, m_out);
    averageNodeRotations(m_body, m_settings);
}

void BentBeam::restoreInput()
{
    prepareSystem();
    forgetRotations();
}

void BentBeam::multiply()
{
    WarpedSystem(m_body).apply(m_in, m_out);
}

void BentBeam::precondition()
{
    WarpedPreconditioner(m_body).apply(m_in, m_out);
}

void BentBeam::solve()
{
    model().factor().lower().solve(m_vector.get(), m_scratch.get());
}

void BentBeam::solveLanes()
{
    const PackedFactor& factor = model().factor().lower();
    factor.solveLanes(factor.allSupernodes(), factor.allSupernodes(), m_lanes.get(), m_lanesScratch.get());
}

// Repeated solves in place would drive the vector out of the range of single precision.
void BentBeam::resetVector()
{
    std::fill(m_vector.get(), m_vector.get() + model().factor().lower().size(), 1.f);
}

void BentBeam::resetLanes()
{
    std::fill(m_lanes.get(), m_lanes.get() + static_cast<std::size_t>(model().factor().lower().size()) * kPanelLanes,
              1.f);
}

}  // namespace bullet_fem
