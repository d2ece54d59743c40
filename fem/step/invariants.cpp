// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/step/stepping.h"

#include "fem/body/internal_stress.h"
#include "fem/common/rotation.h"
#include "fem/elements/law_points.h"
#include "fem/elements/model_elements.h"
#include "fem/laws/mean_dilatation.h"

namespace bullet_fem
{

Vec3 linearMomentum(const BodyState& state)
{
    Vec3 sum;
    for (std::size_t i = 0; i < state.m_x.size(); ++i) sum += state.m_mass[i] * state.m_v[i];
    return sum;
}

Vec3 angularMomentum(const BodyState& state)
{
    Vec3 sum;
    for (std::size_t i = 0; i < state.m_x.size(); ++i) sum += state.m_mass[i] * cross(state.m_x[i], state.m_v[i]);
    return sum;
}

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

}  // namespace

// Element energy: V W(E) of the law, E = sym(R^T F) - I, with the share of lambda that patches average of the patch's
// mean volume change; a smoothed deviator contributes its unsmoothed share and that of its edge domains; initial stress
// adds V sigma_0 : E. The state's rotations are those of the start of the last step, outdated in a spinning body: R is
// recomputed.
double mechanicalEnergy(const Body& body)
{
    const BodyState& s = body.m_state;
    double energy = 0;
    for (std::size_t i = 0; i < s.m_x.size(); ++i) energy += 0.5 * s.m_mass[i] * dot(s.m_v[i], s.m_v[i]);
    const RestShape& shape = body.m_model->shape();
    const ElementPatches& patches = shape.m_patches;
    std::vector<double> dilatation(patches.count(), 0.0);
    std::vector<SymmetricTensor> strain;  // for smoothed elements
    const std::vector<Tet>& tets = shape.m_mesh.tets();
    const std::vector<int>& lane = body.m_model->elements().m_lanes.m_lane;
    for (std::size_t e = 0; e < tets.size(); ++e)
    {
        const int index = static_cast<int>(e);
        const RestElement& element = shape.m_elements[e];
        const Vec3& x0 = s.m_x[tets[e][0]];
        const Mat3 F = Mat3::fromColumns(s.m_x[tets[e][1]] - x0, s.m_x[tets[e][2]] - x0, s.m_x[tets[e][3]] - x0) *
                       element.m_DmInverse;
        const Mat3 E = transposeTimes(polarRotation(F, toMatrix(s.m_elementRotation[lane[e]])), F) - Mat3::identity();
        const Mat3 symmetric = 0.5 * (E + transpose(E));
        const Law& law = lawOf(shape.materialOf(index).m_law);
        LawPoint point = lawPointOf(shape, index, s.m_lawHistory.data());
        if (!patches.empty())
        {
            dilatation[patches.m_patch[e]] += shape.shareOfPatch(index) * volumeChange(law, symmetric);
            shareWithPatch(law, 0, point);
        }
        const bool isSmoothed = !shape.m_edgeDomains.empty();
        const double share = isSmoothed ? 1 - shape.m_edgeDomains.m_share[e] : 1;
        Mat3 elastic = symmetric;  // of the smoothed part
        if (smoothsElasticStrain(body)) elastic = elastic - toMatrix(inelasticStrain(body, index));
        if (isSmoothed) strain.push_back(symmetricPart(elastic));
        energy += share * element.m_volume * law.m_respond(elastic, point).m_energy;
        if (hasInitialStress(body))
            energy += element.m_volume * contraction(initialStress(body, static_cast<int>(e)), symmetricPart(E)) +
                      inelasticEnergy(body, static_cast<int>(e));
    }
    for (std::size_t e = 0; e < tets.size() && !patches.empty(); ++e)
    {
        const int index = static_cast<int>(e);
        const LawPoint point = lawPointOf(shape, index, s.m_lawHistory.data());
        energy += shape.m_elements[e].m_volume *
                  sharedEnergy(lawOf(shape.materialOf(index).m_law), dilatation[patches.m_patch[e]], point);
    }
    return strain.empty() ? energy : energy + energyOfDomains(shape, strain);
}

}  // namespace bullet_fem
