// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/step/stress.h"

#include <algorithm>
#include <cmath>

#include "fem/body/internal_stress.h"
#include "fem/elements/law_points.h"
#include "fem/elements/model_elements.h"
#include "fem/elements/patch_frame.h"
#include "fem/laws/mean_dilatation.h"

namespace bullet_fem
{

double vonMises(const Stress& s)
{
    const double xy = s.xx - s.yy, yz = s.yy - s.zz, zx = s.zz - s.xx;
    const double shear = s.xy * s.xy + s.yz * s.yz + s.xz * s.xz;
    return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3 * shear);
}

namespace
{

// F = R S and the stretch F R^T = R S R^T in world axes. The state's rotations are those of the start of the last step:
// R is recomputed.
struct LeftStretch
{
    Mat3 m_R, m_stretch;
};

LeftStretch leftStretch(const Body& body, int e)
{
    const RestShape& shape = body.m_model->shape();
    const int lane = body.m_model->elements().m_lanes.m_lane[e];
    const Mat3 R = frameRotation(shape, e, body.m_state.m_x, toMatrix(body.m_state.m_elementRotation[lane]));
    return {R, timesTranspose(deformationGradient(shape, e, body.m_state.m_x), R)};
}

// Strain S - I turned to world axes.
Mat3 turnedStrain(const LeftStretch& left)
{
    return 0.5 * (left.m_stretch + transpose(left.m_stretch)) - Mat3::identity();
}

double volumeChangeOf(const Body& body, int e, const LeftStretch& left)
{
    return volumeChange(lawOf(body.m_model->shape().materialOf(e).m_law), turnedStrain(left));
}

SymmetricTensor strainOf(const LeftStretch& found)
{
    SymmetricTensor strain = symmetricPart(transposeTimes(found.m_R, found.m_stretch * found.m_R));
    strain.xx -= 1, strain.yy -= 1, strain.zz -= 1;
    return strain;
}

// sigma = R (dW/dS + sigma_0) R^T. An isotropic law commutes with R.
Stress stressOf(const Body& body, int e, const LeftStretch& found, double dilatation)
{
    const RestShape& shape = body.m_model->shape();
    const Law& law = lawOf(shape.materialOf(e).m_law);
    LawPoint point = lawPointOf(shape, e, body.m_state.m_lawHistory.data());
    if (!shape.m_patches.empty() && shape.m_assumedStrain.empty()) shareWithPatch(law, dilatation, point);
    const bool turns = law.m_kind == LawKind::anisotropic;
    Stress s;
    if (!turns) s = symmetricPart(law.m_respond(turnedStrain(found), point).m_stress);
    if (!turns && !hasInitialStress(body)) return s;
    Stress own;  // in the element's frame
    if (turns) own = symmetricPart(law.m_respond(toMatrix(strainOf(found)), point).m_stress);
    if (hasInitialStress(body)) own += initialStress(body, e);
    return s += symmetricPart(found.m_R * timesTranspose(toMatrix(own), found.m_R));
}

// Replaces the stretches of a patch's elements by those of the assumed strains.
void assumeStretches(const RestShape& shape, int patch, int count, LeftStretch* left)
{
    if (shape.m_assumedStrain.empty()) return;
    SymmetricTensor strain[ElementPatches::kMax];
    double share[ElementPatches::kMax] = {};
    for (int k = 0; k < count; ++k)
    {
        strain[k] = strainOf(left[k]);
        share[k] = shape.shareOfPatch(shape.m_patches.m_element[shape.m_patches.m_start[patch] + k]);
    }
    shape.m_assumedStrain.assume(patch, count, share, strain);
    for (int k = 0; k < count; ++k)
        left[k].m_stretch = Mat3::identity() + left[k].m_R * timesTranspose(toMatrix(strain[k]), left[k].m_R);
}

// Calls visit(e, left stretch, dilatation) for the elements of a patch.
template <class Visit>
void visitPatch(const Body& body, int patch, const Visit& visit)
{
    const RestShape& shape = body.m_model->shape();
    const int* element = &shape.m_patches.m_element[shape.m_patches.m_start[patch]];
    const int count = shape.m_patches.size(patch);
    LeftStretch left[ElementPatches::kMax];
    double dilatation = 0;
    for (int k = 0; k < count; ++k) left[k] = leftStretch(body, element[k]);
    assumeStretches(shape, patch, count, left);
    for (int k = 0; k < count; ++k)
        dilatation += shape.shareOfPatch(element[k]) * volumeChangeOf(body, element[k], left[k]);
    for (int k = 0; k < count; ++k) visit(element[k], left[k], dilatation);
}

}  // namespace

Stress elementStress(const Body& body, int e)
{
    const BodyModel& model = *body.m_model;
    if (model.shape().m_patches.empty())
    {
        const LeftStretch left = leftStretch(body, e);
        return stressOf(body, e, left, 0);
    }
    Stress stress;
    visitPatch(body, model.shape().m_patches.m_patch[e],
               [&](int other, const LeftStretch& left, double dilatation)
               {
                   if (other == e) stress = stressOf(body, e, left, dilatation);
               });
    return stress;
}

void elementStresses(const Body& body, std::vector<Stress>& perElement)
{
    const BodyModel& model = *body.m_model;
    perElement.resize(model.mesh().tetCount());
    const ElementPatches& patches = model.shape().m_patches;
    for (int p = 0; p < patches.count(); ++p)
        visitPatch(body, p,
                   [&](int e, const LeftStretch& left, double dilatation)
                   { perElement[e] = stressOf(body, e, left, dilatation); });
    if (!patches.empty()) return;
    for (std::size_t e = 0; e < perElement.size(); ++e) perElement[e] = elementStress(body, static_cast<int>(e));
}

void nodeStresses(const BodyModel& model, const std::vector<Stress>& perElement, std::vector<Stress>& perNode)
{
    const NodeCorners& nodes = model.elements().m_nodes;
    const std::vector<RestElement>& elements = model.shape().m_elements;
    perNode.resize(model.nodeCount());
    for (int i = 0; i < model.nodeCount(); ++i)
    {
        Stress sum;
        double volume = 0;
        for (int k = nodes.m_start[i]; k < nodes.m_start[i + 1]; ++k)
        {
            const int e = model.elements().m_lanes.m_element[NodeCorners::element(nodes.m_corner[k])];
            Stress part = perElement[e];
            sum += part *= elements[e].m_volume;
            volume += elements[e].m_volume;
        }
        if (volume > 0) sum *= 1 / volume;
        perNode[i] = sum;
    }
}

double waveImpedance(const Body& body)
{
    const RestShape& shape = body.m_model->shape();
    double largest = 0;
    for (const MaterialRegion& region : shape.m_materials.m_regions)
    {
        double density = region.m_material.m_density;
        if (!(density > 0))
        {
            double mass = 0, volume = 0;
            for (const double m : body.m_state.m_mass) mass += m;
            for (const RestElement& element : shape.m_elements) volume += element.m_volume;
            density = mass / volume;
        }
        const ElasticMatrix C = region.m_material.stiffness();
        largest = std::max(largest, std::sqrt(density * std::max({C(0, 0), C(1, 1), C(2, 2)})));
    }
    return largest;
}

}  // namespace bullet_fem
