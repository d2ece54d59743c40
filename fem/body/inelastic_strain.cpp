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

// Replaces the deviators of strains by those that the smoothed stress belongs to: the mean of elastic strains over the
// edge domains, plus the element's own inelastic strain.
template <class Real>
class SmoothedTotals
{
public:
    explicit SmoothedTotals(Body& body)
        : m_body(body),
          m_smoothing(body.m_model->elements().smoothing<Real>()),
          m_strain(body.m_workspace.scratch().m_elements.scratch<Real>().m_smoothed.strain(0))
    {
    }

    void replace(std::vector<StrainBlock<Real>>& strains, const Threads* threads) const
    {
        const int blocks = m_body.m_model->elements().blockCount();
        runRanges(threads, {blocks, kBlocksPerChunk},
                  [&](Range range) { forEachLane(range, [&](int lane) { storeElastic(strains, lane); }); });
        runRanges(threads, {m_smoothing.domainCount(), kDomainsPerChunk},
                  [&](Range domains) { averageStrains(m_smoothing, m_strain, domains); });
        runRanges(threads, {blocks, kBlocksPerChunk},
                  [&](Range range) { forEachLane(range, [&](int lane) { storeTotal(strains, lane); }); });
    }

private:
    template <class Visit>
    static void forEachLane(Range blocks, const Visit& visit)
    {
        for (int lane = blocks.m_begin * kLanes; lane < blocks.m_end * kLanes; ++lane) visit(lane);
    }

    void storeElastic(const std::vector<StrainBlock<Real>>& strains, int lane) const
    {
        SymmetricTensor elastic = strainAt(strains, lane);
        elastic += -1.0 * inelasticStrain(m_body, m_body.m_model->elements().m_lanes.m_element[lane]);
        const double entries[8] = {elastic.xx, elastic.yy, elastic.zz, elastic.yz, elastic.xz, elastic.xy, 0, 0};
        for (int k = 0; k < 8; ++k)
            m_strain.m_element[lane / kLanes].m_quad[k / 4][lane % kLanes][k % 4] = static_cast<Real>(entries[k]);
    }

    void storeTotal(std::vector<StrainBlock<Real>>& strains, int lane) const
    {
        const auto& shares = m_smoothing.m_lanes[lane / kLanes];
        const int at = lane % kLanes;
        double mean[6];
        for (int k = 0; k < 6; ++k)
        {
            mean[k] = double(shares.m_own[at]) * double(m_strain.m_element[lane / kLanes].m_quad[k / 4][at][k % 4]);
            for (const std::int32_t domain : shares.m_domain[at])
                mean[k] += double(shares.m_ofDomain[at]) * double(m_strain.m_domain[domain].m_quad[k / 4][k % 4]);
        }
        SymmetricTensor total = {mean[0], mean[1], mean[2], mean[5], mean[3], mean[4]};
        total += inelasticStrain(m_body, m_body.m_model->elements().m_lanes.m_element[lane]);
        const double entries[6] = {total.xx, total.yy, total.zz, total.yz, total.xz, total.xy};
        for (int k = 0; k < 6; ++k) strains[lane / kLanes].m_entry[k][at] = static_cast<Real>(entries[k]);
    }

    Body& m_body;
    const EdgeSmoothing<Real>& m_smoothing;
    SmoothedStrain<Real> m_strain;
};

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
    const bool isSmoothed = smoothsElasticStrain(body);
    runRanges(settings.m_threads, {elements.blockCount(), kBlocksPerChunk},
              [&](Range blocks)
              {
                  runElementStrains(strains, blocks);
                  if (!isSmoothed) advance(blocks);
              });
    if (!isSmoothed) return;
    SmoothedTotals<Real>(body).replace(scratch.m_strain, settings.m_threads);
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
