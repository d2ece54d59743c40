// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/solve/warped_system.h"

#include <algorithm>
#include <cmath>

#include "fem/body/internal_stress.h"
#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"
#include "fem/common/chunks.h"
#include "fem/common/rotation.h"
#include "fem/elements/assumed_elements.h"
#include "fem/elements/element_product.h"
#include "fem/elements/model_elements.h"
#include "fem/elements/node_sums.h"
#include "fem/elements/orthotropic_elements.h"
#include "fem/factor/rest_factor.h"
#include "fem/factor/rest_modes.h"

namespace bullet_fem
{
namespace
{

constexpr double kFinestSingle = 3e-4;  // finest tolerance of single precision; at 1e-5 it is 1.4e-5 off

void pad(const Threads* threads, const std::vector<Vec3>& from, std::vector<PaddedVec3>& to)
{
    runRanges(threads, {static_cast<int>(from.size()), kEntriesPerChunk},
              [&](Range nodes)
              {
                  for (int i = nodes.m_begin; i < nodes.m_end; ++i) to[i] = {from[i].x, from[i].y, from[i].z, 0};
              });
}

template <class Real>
void sumOverNodes(const Threads* threads, const NodeSums<Real>& sums)
{
    runRanges(threads, {sums.m_nodes->nodeCount(), kNodesPerChunk}, [&](Range nodes) { sumCorners(sums, nodes); });
}

// Element pass arguments: forces, rotations and the parts of A.
template <class Real>
ElementPass<Real> passOver(Body& body, const StepSettings& settings)
{
    const ModelElements& elements = body.m_model->elements();
    ElementWork& work = body.m_workspace.scratch().m_elements;
    ElementScratch<Real>& scratch = work.scratch<Real>();
    scratch.grow(elements.blockCount());
    const double h = settings.m_step;

    ElementPass<Real> pass;
    pass.m_elements = &elements.blocks<Real>();
    pass.m_x = work.m_x.data();
    pass.m_v = work.m_v.data();
    pass.m_damping = 1;  // damping is included in m_v
    pass.m_tensionFactor = settings.m_tension ? StepCoefficients(settings, body).stiffness() * h * h : 0;
    pass.m_rotation = body.m_state.m_elementRotation.data();
    pass.m_force = scratch.m_corners.data();
    pass.m_warped = scratch.m_warped.data();
    if (!pass.m_elements->m_law.empty())
    {
        scratch.m_tangent.resize(elements.blockCount());
        pass.m_tangent = scratch.m_tangent.data();
        pass.m_history = body.m_state.m_lawHistory.data();
    }
    if (hasInitialStress(body))
    {
        scratch.m_initialStress.resize(elements.blockCount());
        gatherInitialStress(body, settings.m_threads, scratch.m_initialStress.data());
        pass.m_initialStress = scratch.m_initialStress.data();
    }
    return pass;
}

template <class Real>
Chunks unitsOf(const ElementBlocks<Real>& elements)
{
    return {elements.workUnitCount(), elements.workUnitsPerChunk()};
}

template <class Real>
void runPass(const ElementPass<Real>& pass, const Threads* threads)
{
    runRanges(threads, unitsOf(*pass.m_elements), [&](Range pieces) { runElementPass(pass, pieces); });
}

/// True if the elements need a StretchPass.
template <class Real>
bool needsStretches(const ElementBlocks<Real>& elements)
{
    return elements.assumesForAnyLaw() || !elements.m_stiffness.empty();
}

template <class Real>
void runPassOfStretches(Body& body, const ElementPass<Real>& pass, const Threads* threads)
{
    const ElementBlocks<Real>& elements = *pass.m_elements;
    auto& warped = body.m_workspace.scratch().m_elements.scratch<Real>().m_stretches;
    warped.resize(elements.blockCount());
    const StretchPass<Real> all = {pass, warped.data()};
    if (elements.assumesForAnyLaw())
        runRanges(threads, unitsOf(elements), [&](Range units) { runAssumedPass(all, units); });
    else
        runRanges(threads, {elements.blockCount(), kBlocksPerChunk},
                  [&](Range blocks) { runOrthotropicPass(all, blocks); });
}

template <class Real>
void runProductOfStretches(const ElementProduct<Real>& product, const StretchBlock<Real>* warped,
                           const Threads* threads)
{
    const ElementBlocks<Real>& elements = *product.m_elements;
    const StretchProduct<Real> all = {product, warped};
    if (elements.assumesForAnyLaw())
        runRanges(threads, unitsOf(elements), [&](Range units) { runAssumedProduct(all, units); });
    else
        runRanges(threads, {elements.blockCount(), kBlocksPerChunk},
                  [&](Range blocks) { runOrthotropicProduct(all, blocks); });
}

// Runs the element pass and adds the forces to `force` [N].
template <class Real>
void passOverElements(Body& body, const StepSettings& settings, std::vector<Vec3>& force)
{
    const ElementPass<Real> pass = passOver<Real>(body, settings);
    if (needsStretches(*pass.m_elements))
        runPassOfStretches(body, pass, settings.m_threads);
    else
        runPass(pass, settings.m_threads);
    sumOverNodes(settings.m_threads,
                 NodeSums<Real>{&body.m_model->elements().m_nodes, pass.m_force, nullptr, nullptr, force.data()});
}

template <class Real>
void product(const Body& body, const Threads* threads, double stiffnessFactor, bool withMass,
             const std::vector<Vec3>& in, std::vector<Vec3>& out)
{
    const ModelElements& elements = body.m_model->elements();
    ElementWork& work = body.m_workspace.scratch().m_elements;
    ElementScratch<Real>& scratch = work.scratch<Real>();
    pad(threads, in, work.m_x);
    const ElementBlocks<Real>& blocks = elements.blocks<Real>();
    const ElementProduct<Real> forces = {
        &blocks,         scratch.m_warped.data(),  stiffnessFactor,
        work.m_x.data(), scratch.m_corners.data(), blocks.m_law.empty() ? nullptr : scratch.m_tangent.data()};
    if (needsStretches(blocks))
        runProductOfStretches(forces, scratch.m_stretches.data(), threads);
    else
        runRanges(threads, unitsOf(blocks), [&](Range pieces) { runElementProduct(forces, pieces); });
    if (!withMass) std::fill(out.begin(), out.end(), Vec3());
    sumOverNodes(threads, NodeSums<Real>{&elements.m_nodes, scratch.m_corners.data(),
                                         withMass ? work.m_scaledMass.data() : nullptr, work.m_x.data(), out.data()});
}

}  // namespace

bool isSinglePrecision(const StepSettings& settings)
{
    return settings.m_tolerance >= kFinestSingle;
}

void scaleWarpedSystem(Body& body, const StepSettings& settings)
{
    const double step = settings.m_step;
    ElementWork& work = body.m_workspace.scratch().m_elements;
    const Material& material = body.m_model->shape().m_material;
    const double alpha = material.m_massDamping + body.m_loads.m_massDamping + body.m_loads.m_frameDamping;
    work.m_stiffnessFactor = step * (StepCoefficients(settings, body).stiffness() * step + material.m_stiffnessDamping);
    for (std::size_t i = 0; i < work.m_scaledMass.size(); ++i)
        work.m_scaledMass[i] = (1 + step * alpha) * body.m_state.m_mass[i];
}

void prepareWarpedSystem(Body& body, const StepSettings& settings, const std::vector<Vec3>& positions,
                         const std::vector<Vec3>& viscous, std::vector<Vec3>& force)
{
    ElementWork& work = body.m_workspace.scratch().m_elements;
    work.m_isDouble = !isSinglePrecision(settings);
    work.m_isComplete = true;
    if (work.m_stepsReadyForImpulses > 0) --work.m_stepsReadyForImpulses;
    scaleWarpedSystem(body, settings);
    pad(settings.m_threads, positions, work.m_x);
    pad(settings.m_threads, viscous, work.m_v);
    if (work.m_isDouble)
        passOverElements<double>(body, settings, force);
    else
        passOverElements<float>(body, settings, force);
}

void averageNodeRotations(Body& body, const StepSettings& settings)
{
    const ModelElements& elements = body.m_model->elements();
    BodyState& state = body.m_state;
    std::vector<NodeRotation>& R = body.m_workspace.scratch().m_elements.m_nodeRotation;
    if (settings.m_warp == Warp::nodal)
    {
        const NodeRotations average = {&elements.m_nodes, state.m_elementRotation.data(), R.data()};
        return runRanges(settings.m_threads, {body.m_model->nodeCount(), kNodesPerChunk},
                         [&](Range nodes) { averageRotations(average, nodes); });
    }
    const Mat3 sum = sumRotations(elements.m_nodes, state.m_elementRotation.data(), {0, elements.blockCount()});
    state.m_bodyRotation = polarRotation(sum, state.m_bodyRotation);
    NodeRotation Q;
    for (int k = 0; k < 9; ++k) Q.m[k] = static_cast<float>(state.m_bodyRotation(k / 3, k % 3));
    std::fill(R.begin(), R.end(), Q);
}

void completeWarpedSystem(Body& body, const StepSettings& settings)
{
    ElementWork& work = body.m_workspace.scratch().m_elements;
    work.m_stepsReadyForImpulses = kStepsReadyForImpulses;
    if (work.m_isComplete) return;
    work.m_isComplete = true;
    scaleWarpedSystem(body, settings);
    pad(settings.m_threads, body.m_workspace.scratch().m_kickPosition, work.m_x);
    ElementPass<float> pass = passOver<float>(body, settings);
    pass.m_isRotated = true;
    runPass(pass, settings.m_threads);
}

void WarpedSystem::multiply(double stiffnessFactor, bool withMass, const std::vector<Vec3>& in,
                            std::vector<Vec3>& out) const
{
    if (m_body.m_workspace.scratch().m_elements.m_isDouble)
        product<double>(m_body, m_threads, stiffnessFactor, withMass, in, out);
    else
        product<float>(m_body, m_threads, stiffnessFactor, withMass, in, out);
}

void WarpedSystem::applyUnconstrained(const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    multiply(m_body.m_workspace.scratch().m_elements.m_stiffnessFactor, true, in, out);
}

void WarpedSystem::applyStiffness(const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    multiply(m_body.m_workspace.scratch().m_elements.m_stiffnessFactor, false, in, out);
    addActuators(in, out);
    clearFixed(out);
}

void WarpedSystem::applyTension(const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    multiply(0, false, in, out);
}

void WarpedSystem::apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    applyUnconstrained(in, out);
    addActuators(in, out);
    clearFixed(out);
    m_body.m_workspace.scratch().m_momentum.removeImpulses(m_body, out);
}

void WarpedSystem::addActuators(const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    if (!m_body.m_actuators.hasPulls()) return;
    m_body.m_workspace.scratch().m_actuation.addProduct(m_body.m_actuators, in, out);
}

void WarpedSystem::clearFixed(std::vector<Vec3>& out) const
{
    const std::vector<unsigned char>& fixed = m_body.m_state.m_fixed;
    for (std::size_t i = 0; i < out.size(); ++i)
        if (fixed[i]) out[i] = {};
}

Mat3 WarpedPreconditioner::rotation(int node) const
{
    const float* R = m_body.m_workspace.scratch().m_elements.m_nodeRotation[node].m;
    return {{{R[0], R[1], R[2]}, {R[3], R[4], R[5]}, {R[6], R[7], R[8]}}};
}

// Factor vector <- R^T in / scale with the maximum norm of `in` as scale, so that the range of single precision does
// not matter. Returns the scale.
double WarpedPreconditioner::rotateIn(const std::vector<Vec3>& in) const
{
    const RestFactor& factor = m_body.m_model->factor();
    const std::vector<unsigned char>& fixed = m_body.m_state.m_fixed;
    const std::vector<NodeRotation>& R = m_body.m_workspace.scratch().m_elements.m_nodeRotation;
    float* y = m_body.m_workspace.scratch().m_factor.m_vector.get();

    double largest = 0;
    for (const Vec3& r : in) largest = std::max({largest, std::fabs(r.x), std::fabs(r.y), std::fabs(r.z)});
    const double down = largest > 0 ? 1 / largest : 0;
    runRanges(m_threads, {static_cast<int>(in.size()), kNodesPerChunk},
              [&](Range nodes)
              {
                  for (int i = nodes.m_begin; i < nodes.m_end; ++i)
                  {
                      const int k = factor.position(i);
                      if (k < 0) continue;
                      const Vec3 r = fixed[i] ? Vec3() : down * in[i];
                      const float rx = static_cast<float>(r.x), ry = static_cast<float>(r.y),
                                  rz = static_cast<float>(r.z);
                      const float* m = R[i].m;
                      for (int c = 0; c < 3; ++c) y[3 * k + c] = m[c] * rx + m[3 + c] * ry + m[6 + c] * rz;
                  }
              });
    return largest;
}

// out <- scale R (factor vector).
void WarpedPreconditioner::rotateOut(const std::vector<Vec3>& in, double scale, std::vector<Vec3>& out) const
{
    const RestFactor& factor = m_body.m_model->factor();
    const std::vector<unsigned char>& fixed = m_body.m_state.m_fixed;
    const std::vector<NodeRotation>& R = m_body.m_workspace.scratch().m_elements.m_nodeRotation;
    const float* y = m_body.m_workspace.scratch().m_factor.m_vector.get();
    runRanges(m_threads, {static_cast<int>(in.size()), kNodesPerChunk},
              [&](Range nodes)
              {
                  for (int i = nodes.m_begin; i < nodes.m_end; ++i)
                  {
                      const int k = factor.position(i);
                      if (fixed[i])
                          out[i] = {};
                      else if (k < 0)
                          out[i] = (1 / factor.diagonal(i)) * in[i];
                      else
                      {
                          const float *m = R[i].m, *q = y + 3 * static_cast<std::size_t>(k);
                          const auto row = [m, q](int c)
                          { return m[3 * c] * q[0] + m[3 * c + 1] * q[1] + m[3 * c + 2] * q[2]; };
                          out[i] = {scale * row(0), scale * row(1), scale * row(2)};
                      }
                  }
              });
}

void WarpedPreconditioner::apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    const double scale = rotateIn(in);
    FactorWork& work = m_body.m_workspace.scratch().m_factor;
    const RigidMomentum& rigid = m_body.m_workspace.scratch().m_momentum;
    const RestModes& rest = m_body.m_model->restModes();
    if (rigid.hasRestModes()) rest.removeImpulses(work.m_vector.get(), work.m_motions);
    m_body.m_model->factor().lower().solve(work.m_vector.get(), work.m_scratch.get(), m_threads);
    if (rigid.hasRestModes()) rest.replaceMotions(work.m_vector.get(), work.m_motions);
    rotateOut(in, scale, out);
    rigid.removeMotion(m_body, out);
}

}  // namespace bullet_fem
