// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/step/elastic_energy.h"

#include <algorithm>

#include "fem/body/internal_stress.h"
#include "fem/body/step_scratch.h"
#include "fem/common/rotation.h"
#include "fem/elements/law_points.h"
#include "fem/elements/model_elements.h"
#include "fem/laws/mean_dilatation.h"

namespace bullet_fem
{
namespace
{

// Sum over all edge domains of mu |dev(s_k)|^2 times the smoothed volume.
double energyOfDomains(const RestShape& shape, const std::vector<SymmetricTensor>& strain)
{
    const EdgeDomains& domains = shape.m_edgeDomains;
    double energy = 0;
    for (int d = 0; d < domains.count(); ++d)
    {
        SymmetricTensor mean;
        double muVolume = 0;
        for (int k = domains.m_start[d]; k < domains.m_start[d + 1]; ++k)
        {
            const int e = domains.m_element[k];
            mean += domains.m_weight[k] * deviator(strain[e]);
            muVolume += domains.m_share[e] / 6 * shape.m_elements[e].m_muVolume;
        }
        energy += muVolume * contraction(mean, mean);
    }
    return energy;
}

// F of element e at positions x.
Mat3 deformationGradient(const RestShape& shape, int e, const std::vector<Vec3>& x)
{
    const Tet& tet = shape.m_mesh.tets()[e];
    const Vec3& x0 = x[tet[0]];
    return Mat3::fromColumns(x[tet[1]] - x0, x[tet[2]] - x0, x[tet[3]] - x0) * shape.m_elements[e].m_DmInverse;
}

}  // namespace

// Element energy: V W(E) of the law, E = sym(R^T F) - I, with the share of lambda that patches average of the patch's
// mean volume change; a smoothed deviator contributes its unsmoothed share and that of its edge domains; initial stress
// adds V sigma_0 : E. The state's rotations are those of the start of the last step, outdated in a spinning body: R is
// recomputed.
double elasticEnergy(const Body& body, const std::vector<Vec3>& x)
{
    const RestShape& shape = body.m_model->shape();
    const ElementPatches& patches = shape.m_patches;
    const EdgeDomains& domains = shape.m_edgeDomains;
    const std::vector<int>& lane = body.m_model->elements().m_lanes.m_lane;
    const BodyState& s = body.m_state;
    ElasticEnergyScratch& scratch = body.m_workspace.scratch().m_elasticEnergy;
    std::fill(scratch.m_dilatation.begin(), scratch.m_dilatation.end(), 0.0);
    double energy = 0;
    for (int e = 0; e < shape.m_mesh.tetCount(); ++e)
    {
        const double volume = shape.m_elements[e].m_volume;
        const Mat3 F = deformationGradient(shape, e, x);
        const Mat3 E = transposeTimes(polarRotation(F, toMatrix(s.m_elementRotation[lane[e]])), F) - Mat3::identity();
        const Mat3 symmetric = 0.5 * (E + transpose(E));
        const Law& law = lawOf(shape.materialOf(e).m_law);
        LawPoint point = lawPointOf(shape, e, s.m_lawHistory.data());
        if (!patches.empty())
        {
            scratch.m_dilatation[patches.m_patch[e]] += shape.shareOfPatch(e) * volumeChange(law, symmetric);
            shareWithPatch(law, 0, point);
        }
        const Mat3 elastic = smoothsElasticStrain(body) ? symmetric - toMatrix(inelasticStrain(body, e))
                                                        : symmetric;  // of smoothed parts
        if (!domains.empty()) scratch.m_strain[e] = symmetricPart(elastic);
        const double share = domains.empty() ? 1 : 1 - domains.m_share[e];
        energy += share * volume * law.m_respond(elastic, point).m_energy;
        if (hasInitialStress(body))
            energy += volume * contraction(initialStress(body, e), symmetricPart(E)) + inelasticEnergy(body, e);
    }
    for (int e = 0; e < shape.m_mesh.tetCount() && !patches.empty(); ++e)
        energy += shape.m_elements[e].m_volume * sharedEnergy(lawOf(shape.materialOf(e).m_law),
                                                              scratch.m_dilatation[patches.m_patch[e]],
                                                              lawPointOf(shape, e, s.m_lawHistory.data()));
    return domains.empty() ? energy : energy + energyOfDomains(shape, scratch.m_strain);
}

}  // namespace bullet_fem
