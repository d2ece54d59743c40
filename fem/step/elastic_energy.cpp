// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/step/elastic_energy.h"

#include <algorithm>

#include "fem/body/internal_stress.h"
#include "fem/body/step_scratch.h"
#include "fem/elements/law_points.h"
#include "fem/elements/model_elements.h"
#include "fem/elements/patch_frame.h"
#include "fem/laws/mean_dilatation.h"

namespace bullet_fem
{
namespace
{

// E = sym(R^T F) - I. The state's rotations are those of the start of the last step, outdated in a spinning body: R is
// recomputed.
SymmetricTensor strainOf(const Body& body, int e, const std::vector<Vec3>& x)
{
    const RestShape& shape = body.m_model->shape();
    const int lane = body.m_model->elements().m_lanes.m_lane[e];
    const Mat3 R = frameRotation(shape, e, x, toMatrix(body.m_state.m_elementRotation[lane]));
    return symmetricPart(transposeTimes(R, deformationGradient(shape, e, x)) - Mat3::identity());
}

// Stores the assumed strains of all elements.
void assumeStrains(const Body& body, const std::vector<Vec3>& x, std::vector<SymmetricTensor>& strains)
{
    const RestShape& shape = body.m_model->shape();
    const ElementPatches& patches = shape.m_patches;
    for (int p = 0; p < patches.count() && !shape.m_assumedStrain.empty(); ++p)
    {
        const int *element = &patches.m_element[patches.m_start[p]], count = patches.size(p);
        SymmetricTensor strain[ElementPatches::kMax];
        double share[ElementPatches::kMax] = {};
        for (int k = 0; k < count; ++k)
        {
            strain[k] = strainOf(body, element[k], x);
            share[k] = shape.shareOfPatch(element[k]);
        }
        shape.m_assumedStrain.assume(p, count, share, strain);
        for (int k = 0; k < count; ++k) strains[element[k]] = strain[k];
    }
}

}  // namespace

// Element energy: V W(E) of the law, with the share of lambda that patches average of the patch's mean volume change;
// initial stress adds V sigma_0 : E.
double elasticEnergy(const Body& body, const std::vector<Vec3>& x)
{
    const RestShape& shape = body.m_model->shape();
    const ElementPatches& patches = shape.m_patches;
    const BodyState& s = body.m_state;
    ElasticEnergyScratch& scratch = body.m_workspace.scratch().m_elasticEnergy;
    std::fill(scratch.m_dilatation.begin(), scratch.m_dilatation.end(), 0.0);
    assumeStrains(body, x, scratch.m_strain);
    const bool sharesVolume = !patches.empty() && shape.m_assumedStrain.empty();  // assumed strains share it already
    double energy = 0;
    for (int e = 0; e < shape.m_mesh.tetCount(); ++e)
    {
        const double volume = shape.m_elements[e].m_volume;
        const SymmetricTensor strain = shape.m_assumedStrain.empty() ? strainOf(body, e, x) : scratch.m_strain[e];
        const Law& law = lawOf(shape.materialOf(e).m_law);
        LawPoint point = lawPointOf(shape, e, s.m_lawHistory.data());
        if (sharesVolume)
        {
            scratch.m_dilatation[patches.m_patch[e]] += shape.shareOfPatch(e) * volumeChange(law, toMatrix(strain));
            shareWithPatch(law, 0, point);
        }
        energy += volume * law.m_respond(toMatrix(strain), point).m_energy;
        if (hasInitialStress(body))
            energy += volume * contraction(initialStress(body, e), strain) + inelasticEnergy(body, e);
    }
    for (int e = 0; e < shape.m_mesh.tetCount() && sharesVolume; ++e)
        energy += shape.m_elements[e].m_volume * sharedEnergy(lawOf(shape.materialOf(e).m_law),
                                                              scratch.m_dilatation[patches.m_patch[e]],
                                                              lawPointOf(shape, e, s.m_lawHistory.data()));
    return energy;
}

}  // namespace bullet_fem
