// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/step/elastic_energy.h"

#include <algorithm>

#include "fem/body/internal_stress.h"
#include "fem/body/step_scratch.h"
#include "fem/common/rotation.h"
#include "fem/elements/model_elements.h"
#include "fem/elements/neo_hooke.h"

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

// Energy of a strain, without the parts of patches and edge domains.
double energyOfElement(const RestShape& shape, int e, const Mat3& strain)
{
    const RestElement& element = shape.m_elements[e];
    // A patch has the mean dilatation; here is the deviator's part only.
    const double lambda = shape.m_patches.empty() ? element.m_lambdaVolume : -2.0 / 3 * element.m_muVolume;
    if (shape.isOrthotropic())
        return 0.5 * element.m_volume *
               contraction(stressOf(shape.stiffnessOf(e), symmetricPart(strain)), symmetricPart(strain));
    if (shape.materialOf(e).m_law == ElasticLaw::neoHooke) return neoHooke(strain, lambda, element.m_muVolume).m_energy;
    const double share = shape.m_edgeDomains.empty() ? 1 : 1 - shape.m_edgeDomains.m_share[e];
    const double dilatation = trace(strain);
    return share * (element.m_muVolume * squaredNorm(strain) + 0.5 * lambda * dilatation * dilatation);
}

}  // namespace

// Element energy: V (mu E:E + lambda/2 tr(E)^2) or V/2 E:C:E, E = sym(R^T F) - I, with the patch's mean in place of
// tr(E) for patches; a smoothed deviator contributes its unsmoothed share and that of its edge domains; initial stress
// adds V sigma_0 : E. The state's rotations are those of the start of the last step, outdated in a spinning body: R is
// recomputed.
double elasticEnergy(const Body& body, const std::vector<Vec3>& x)
{
    const RestShape& shape = body.m_model->shape();
    const ElementPatches& patches = shape.m_patches;
    ElasticEnergyScratch& scratch = body.m_workspace.scratch().m_elasticEnergy;
    std::fill(scratch.m_dilatation.begin(), scratch.m_dilatation.end(), 0.0);
    const bool isStressed = hasInitialStress(body);
    const std::vector<int>& lane = body.m_model->elements().m_lanes.m_lane;
    double energy = 0;
    for (int e = 0; e < shape.m_mesh.tetCount(); ++e)
    {
        const Mat3 F = deformationGradient(shape, e, x);
        const Mat3 guess = toMatrix(body.m_state.m_elementRotation[lane[e]]);
        const Mat3 E = transposeTimes(polarRotation(F, guess), F) - Mat3::identity();
        const Mat3 symmetric = 0.5 * (E + transpose(E));
        energy += energyOfElement(shape, e, symmetric);
        if (!patches.empty()) scratch.m_dilatation[patches.m_patch[e]] += shape.shareOfPatch(e) * trace(symmetric);
        if (!shape.m_edgeDomains.empty()) scratch.m_strain[e] = symmetricPart(E);
        if (isStressed)
            energy += shape.m_elements[e].m_volume * contraction(initialStress(body, e), symmetricPart(E)) +
                      inelasticEnergy(body, e);
    }
    for (int e = 0; e < shape.m_mesh.tetCount() && !patches.empty(); ++e)
    {
        const double mean = scratch.m_dilatation[patches.m_patch[e]];
        const RestElement& element = shape.m_elements[e];
        energy += 0.5 * (element.m_lambdaVolume + 2.0 / 3 * element.m_muVolume) * mean * mean;
    }
    return shape.m_edgeDomains.empty() ? energy : energy + energyOfDomains(shape, scratch.m_strain);
}

}  // namespace bullet_fem
