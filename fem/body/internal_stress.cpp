// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/body/internal_stress.h"

#include <cmath>
#include <stdexcept>

#include "bullet_fem/fem/body/initial_stress.h"
#include "fem/common/chunks.h"
#include "fem/common/message.h"
#include "fem/elements/model_elements.h"

namespace bullet_fem
{
namespace
{

bool isInRange(const SymmetricTensor& s)
{
    for (const double value : {s.xx, s.yy, s.zz, s.xy, s.yz, s.xz})
        if (!(std::fabs(value) <= kMaxInitialStress)) return false;
    return true;
}

}  // namespace

bool isInitialStress(const BodyModel& model, const std::vector<SymmetricTensor>& perElement, std::string* why)
{
    if (!perElement.empty() && static_cast<int>(perElement.size()) != model.mesh().tetCount())
    {
        if (why)
            *why = message("initial stress: ", perElement.size(), " tensors given for ", model.mesh().tetCount(),
                           " elements; give one each or none");
        return false;
    }
    for (std::size_t e = 0; e < perElement.size(); ++e)
        if (!isInRange(perElement[e]))
        {
            const SymmetricTensor& s = perElement[e];
            if (why)
                *why = message("initial stress of element ", e, " is (", s.xx, ", ", s.yy, ", ", s.zz, ", ", s.xy, ", ",
                               s.yz, ", ", s.xz, ") Pa, outside [-1e13, 1e13]; give stresses below Young's modulus");
            return false;
        }
    return true;
}

void setInitialStress(Body& body, const std::vector<SymmetricTensor>& perElement)
{
    std::string why;
    if (!isInitialStress(*body.m_model, perElement, &why)) reject(why);
    BodyState& state = body.m_state;
    if (state.m_initialStress == perElement) return;
    state.m_initialStress = perElement;
    ++state.m_initialStressChanges;
}

bool hasInitialStress(const Body& body)
{
    const BodyState& state = body.m_state;
    return !state.m_initialStress.empty() || !state.m_plasticStrain.empty() || !state.m_relaxedStrain.empty();
}

namespace
{

SymmetricTensor givenStress(const Body& body, int e)
{
    const std::vector<SymmetricTensor>& stress = body.m_state.m_initialStress;
    const RestShape& shape = body.m_model->shape();
    if (shape.m_patches.empty()) return stress[e];
    const int patch = shape.m_patches.m_patch[e];
    double pressure = 0;
    for (int k = shape.m_patches.m_start[patch]; k < shape.m_patches.m_start[patch + 1]; ++k)
    {
        const int other = shape.m_patches.m_element[k];
        pressure += shape.shareOfPatch(other) * trace(stress[other]) / 3;
    }
    SymmetricTensor result = deviator(stress[e]);
    return result.xx += pressure, result.yy += pressure, result.zz += pressure, result;
}

}  // namespace

SymmetricTensor relaxedStrain(const Body& body, int e)
{
    SymmetricTensor sum;
    const std::vector<SymmetricTensor>& alpha = body.m_state.m_relaxedStrain;
    if (alpha.empty()) return sum;
    const Material& material = body.m_model->shape().materialOf(e);
    const int terms = body.m_model->shape().m_materials.relaxationTerms();
    for (int i = 0; i < terms; ++i)
        sum += material.m_relaxation[i].m_share * alpha[static_cast<std::size_t>(e) * terms + i];
    return sum;
}

namespace
{

// V times initialStress().
SymmetricTensor stressTimesVolume(const Body& body, int e)
{
    const BodyState& state = body.m_state;
    const RestElement& element = body.m_model->shape().m_elements[e];
    SymmetricTensor stress;
    if (!state.m_initialStress.empty()) stress = element.m_volume * givenStress(body, e);
    if (!state.m_relaxedStrain.empty()) stress += -2 * element.m_muVolume * relaxedStrain(body, e);
    if (!state.m_plasticStrain.empty()) stress += -2 * element.m_muVolume * state.m_plasticStrain[e];
    return stress;
}

}  // namespace

SymmetricTensor initialStress(const Body& body, int e)
{
    return 1 / body.m_model->shape().m_elements[e].m_volume * stressTimesVolume(body, e);
}

double inelasticEnergy(const Body& body, int e)
{
    const BodyState& state = body.m_state;
    const Material& material = body.m_model->shape().materialOf(e);
    double sum = 0;
    const int terms = state.m_relaxedStrain.empty() ? 0 : body.m_model->shape().m_materials.relaxationTerms();
    for (int i = 0; i < terms; ++i)
    {
        const SymmetricTensor& alpha = state.m_relaxedStrain[static_cast<std::size_t>(e) * terms + i];
        sum += material.m_relaxation[i].m_share * contraction(alpha, alpha);
    }
    if (!state.m_plasticStrain.empty())
    {
        const SymmetricTensor& plastic = state.m_plasticStrain[e];
        sum += contraction(plastic, plastic) + 2 * contraction(plastic, relaxedStrain(body, e));
    }
    return body.m_model->shape().m_elements[e].m_muVolume * sum;
}

namespace
{

// V times the stress that does the work of initialStress() in the assumed strain on the element's own strain.
SymmetricTensor workingStress(const Body& body, int e)
{
    const RestShape& shape = body.m_model->shape();
    if (shape.m_assumedStrain.empty()) return stressTimesVolume(body, e);
    const int patch = shape.m_patches.m_patch[e];
    SymmetricTensor sum;
    for (int k = shape.m_patches.m_start[patch]; k < shape.m_patches.m_start[patch + 1]; ++k)
        sum += stressTimesVolume(body, shape.m_patches.m_element[k]);
    const SymmetricTensor mean = shape.shareOfPatch(e) * sum;
    return mean + shape.m_assumedStrain.filtered(patch, stressTimesVolume(body, e) + -1.0 * mean);
}

}  // namespace

template <class Real>
void gatherInitialStress(const Body& body, const Threads* threads, StressBlock<Real>* out)
{
    const std::vector<int>& elementAt = body.m_model->elements().m_lanes.m_element;
    runRanges(threads, {body.m_model->elements().blockCount(), kBlocksPerChunk},
              [&](Range blocks)
              {
                  for (int lane = blocks.m_begin * kLanes; lane < blocks.m_end * kLanes; ++lane)
                  {
                      const SymmetricTensor s = workingStress(body, elementAt[lane]);
                      const double entries[6] = {s.xx, s.yy, s.zz, s.yz, s.xz, s.xy};
                      for (int k = 0; k < 6; ++k)
                          out[lane / kLanes].m_entry[k][lane % kLanes] = static_cast<Real>(entries[k]);
                  }
              });
}

template void gatherInitialStress(const Body&, const Threads*, StressBlock<float>*);
template void gatherInitialStress(const Body&, const Threads*, StressBlock<double>*);

}  // namespace bullet_fem
