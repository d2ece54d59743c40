// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/body/inelastic_strain.h"

#include <cmath>

#include "fem/body/internal_stress.h"
#include "fem/body/step_scratch.h"
#include "fem/common/chunks.h"
#include "fem/elements/law_points.h"
#include "fem/elements/model_elements.h"
#include "fem/laws/prony.h"
#include "fem/laws/von_mises.h"

namespace bullet_fem
{
namespace
{

/// A material's laws for one step.
struct InelasticLaw
{
    InelasticLaw(const Material& material, double step)
        : m_material(material),
          m_law(lawOf(material.m_law)),
          m_flow(-std::expm1(-step * material.m_plasticCreep)),
          m_terms(material.relaxationTerms())
    {
        for (int i = 0; i < m_terms; ++i) m_relaxation[i] = PronyStep(step, material.m_relaxation[i].m_time);
    }

    const Material& m_material;
    const Law& m_law;
    double m_flow;  // share of the stress beyond the yield stress that relaxes in the step [-]
    int m_terms;
    PronyStep m_relaxation[Material::kMaxRelaxationTerms];
};

class InelasticStrain
{
public:
    InelasticStrain(Body& body, double step)
        : m_body(body),
          m_step(step),
          m_first(body.m_model->shape().m_material, step),
          m_maxTerms(body.m_state.m_relaxedStrain.size() / body.m_model->shape().m_elements.size())
    {
    }

    // Advances element e, whose strain is given.
    void advance(int e, const SymmetricTensor& strain) const
    {
        const SymmetricTensor total = deviator(strain);
        // Skips slivers that are not finite in single precision.
        if (!std::isfinite(contraction(total, total))) return;
        const ElementMaterials& materials = m_body.m_model->shape().m_materials;
        if (materials.isUniform()) return advance(e, strain, m_first);
        advance(e, strain, InelasticLaw(materials.of(e), m_step));
    }

private:
    void advance(int e, const SymmetricTensor& strain, const InelasticLaw& law) const
    {
        if (law.m_terms > 0) relax(e, deviator(strain), law);
        if (law.m_material.yields()) flow(e, deviator(strain), law);
        if (!law.m_law.m_advance) return;
        std::vector<double>& history = m_body.m_state.m_lawHistory;
        const RestShape& shape = m_body.m_model->shape();
        double* own = &history[static_cast<std::size_t>(e) * shape.m_materials.historyCount()];
        law.m_law.m_advance(toMatrix(strain), lawPointOf(shape, e, history.data()), own);
    }

    void relax(int e, SymmetricTensor elastic, const InelasticLaw& law) const
    {
        BodyState& state = m_body.m_state;
        if (!state.m_plasticStrain.empty()) elastic += -1.0 * state.m_plasticStrain[e];
        SymmetricTensor* alpha = &state.m_relaxedStrain[e * m_maxTerms];
        for (int i = 0; i < law.m_terms; ++i) law.m_relaxation[i].relax(elastic, alpha[i]);
    }

    void flow(int e, SymmetricTensor elastic, const InelasticLaw& law) const
    {
        const Material& material = law.m_material;
        BodyState& state = m_body.m_state;
        const RestElement& element = m_body.m_model->shape().m_elements[e];
        const VonMises vonMises = {element.m_muVolume / element.m_volume, material.m_yieldStress,
                                   material.m_hardeningModulus, law.m_flow, material.m_mostPlasticStrain};
        elastic += -1.0 * state.m_plasticStrain[e];
        elastic += -1.0 * relaxedStrain(m_body, e);
        SymmetricTensor s = 2 * vonMises.m_mu * elastic;
        if (!state.m_initialStress.empty()) s += deviator(state.m_initialStress[e]);
        vonMises.flow(s, state.m_plasticStrain[e], state.m_equivalentPlasticStrain[e]);
    }

    Body& m_body;
    double m_step;           // [s]
    InelasticLaw m_first;    // law of a uniform body
    std::size_t m_maxTerms;  // entries of m_relaxedStrain per element
};

// The strain of a lane.
template <class Real>
SymmetricTensor strainAt(const std::vector<StrainBlock<Real>>& strains, int lane)
{
    const auto& E = strains[lane / kLanes].m_entry;
    const int k = lane % kLanes;
    return {E[0][k], E[1][k], E[2][k], E[5][k], E[3][k], E[4][k]};
}

// Replaces the strains of patches by the assumed ones.
template <class Real>
void assumeStrains(const RestShape& shape, const ElementLanes& lanes, Range patches,
                   std::vector<StrainBlock<Real>>& strains)
{
    for (int p = patches.m_begin; p < patches.m_end; ++p)
    {
        const int *element = &shape.m_patches.m_element[shape.m_patches.m_start[p]], count = shape.m_patches.size(p);
        SymmetricTensor strain[ElementPatches::kMax];
        double share[ElementPatches::kMax] = {};
        for (int k = 0; k < count; ++k)
        {
            strain[k] = strainAt(strains, lanes.m_lane[element[k]]);
            share[k] = shape.shareOfPatch(element[k]);
        }
        shape.m_assumedStrain.assume(p, count, share, strain);
        for (int k = 0; k < count; ++k)
        {
            const SymmetricTensor& s = strain[k];
            const double entries[6] = {s.xx, s.yy, s.zz, s.yz, s.xz, s.xy};
            const int lane = lanes.m_lane[element[k]];
            for (int i = 0; i < 6; ++i)
                strains[lane / kLanes].m_entry[i][lane % kLanes] = static_cast<Real>(entries[i]);
        }
    }
}

template <class Real>
void advanceAll(Body& body, const StepSettings& settings)
{
    const ModelElements& elements = body.m_model->elements();
    ElementWork& work = body.m_workspace.scratch().m_elements;
    ElementScratch<Real>& scratch = work.scratch<Real>();
    scratch.m_strain.resize(elements.blockCount());
    const ElementStrains<Real> strains = {&elements.blocks<Real>(), work.m_x.data(),
                                          body.m_state.m_elementRotation.data(), scratch.m_strain.data()};
    const InelasticStrain inelastic(body, settings.m_step);
    const ElementLanes& lanes = elements.m_lanes;
    const auto advance = [&](Range blocks)
    {
        for (int lane = blocks.m_begin * kLanes; lane < blocks.m_end * kLanes; ++lane)
            if (!lanes.isCopy(lane)) inelastic.advance(lanes.m_element[lane], strainAt(scratch.m_strain, lane));
    };
    const RestShape& shape = body.m_model->shape();
    if (shape.m_assumedStrain.empty())
    {
        runRanges(settings.m_threads, {elements.blockCount(), kBlocksPerChunk},
                  [&](Range blocks)
                  {
                      runElementStrains(strains, blocks);
                      advance(blocks);
                  });
        return;
    }
    const ElementBlocks<Real>& units = elements.blocks<Real>();
    runRanges(settings.m_threads, {units.workUnitCount(), units.workUnitsPerChunk()},
              [&](Range groups) { runElementStrains(strains, groups); });
    runRanges(settings.m_threads, {shape.m_patches.count(), kPatchesPerChunk},
              [&](Range patches) { assumeStrains(shape, lanes, patches, scratch.m_strain); });
    runRanges(settings.m_threads, {elements.blockCount(), kBlocksPerChunk}, advance);
}

}  // namespace

void advanceInelasticStrain(Body& body, const StepSettings& settings)
{
    const ElementMaterials& materials = body.m_model->shape().m_materials;
    if (!materials.yields() && materials.relaxationTerms() == 0 && materials.historyCount() == 0) return;
    ElementWork& work = body.m_workspace.scratch().m_elements;
    const std::vector<Vec3>& x = body.m_state.m_x;
    for (std::size_t i = 0; i < x.size(); ++i) work.m_x[i] = {x[i].x, x[i].y, x[i].z, 0};
    if (work.m_isDouble)
        advanceAll<double>(body, settings);
    else
        advanceAll<float>(body, settings);
}

}  // namespace bullet_fem
