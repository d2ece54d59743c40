// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/record/btFemTooSoft.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "bullet_fem/fem/laws/law_table.h"
#include "plugin/record/btFemRigidFit.h"

using namespace bullet_fem;

namespace
{

// Ratio rho g H / E beyond which a body is reported as too soft [-]. Cubes on a plane with Hooke's law stand at .55 in
// meshes of four and eight cells across, and have inverted elements at .7 (docs/manual.md, How stiff must my body be;
// SoftPresets).
constexpr double kMaxWeightStrain = 0.5;

}  // namespace

// Extent along gravity of the largest connected component [m].
double btFemTooSoft::extentAlong(const TetMesh& mesh, const Vec3& direction)
{
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    m_spans.assign(mesh.componentCount(), {kInfinite, -kInfinite});
    for (int i = 0; i < mesh.nodeCount(); ++i)
    {
        Span& span = m_spans[mesh.nodeComponent()[i]];
        const double height = dot(direction, mesh.restPositions()[i]);
        span.m_low = std::min(span.m_low, height);
        span.m_high = std::max(span.m_high, height);
    }
    double most = 0;
    for (const Span& span : m_spans) most = std::max(most, span.m_high - span.m_low);
    return most;
}

// rho g H / E [-].
double btFemTooSoft::weightStrain(const FemSoftBody& fem)
{
    const double strength = norm(m_gravity);
    if (!(strength > 0) || !isFinite(m_gravity)) return 0;
    const RestShape& shape = fem.m_body.m_model->shape();
    const Vec3 down = transposeTimes(btFemRigidFit(fem).rotation(), 1 / strength * m_gravity);
    double volume = 0, give = 0;  // [m3], [m3/Pa]
    for (int e = 0; e < shape.m_mesh.tetCount(); ++e)
    {
        const Material& material = shape.materialOf(e);
        volume += shape.m_elements[e].m_volume;
        if (!stiffensInCompression(material.m_law))
            give += shape.m_elements[e].m_volume * material.slowCompliance(down);
    }
    return m_mass / volume * strength * extentAlong(shape.m_mesh, down) * give / volume;
}

bool btFemTooSoft::look(const FemSoftBody& fem)
{
    const std::vector<double>& masses = fem.m_body.m_state.m_mass;
    double mass = 0;  // mass of nodes that elements use
    for (std::size_t i = 0; i < masses.size(); ++i)
        if (!fem.m_body.m_model->mesh().isLoose(static_cast<int>(i))) mass += masses[i];
    const Vec3 gravity = fem.gravity();
    const bool asBefore = m_shape.lock() == fem.m_body.m_model->sharedShape() && mass == m_mass &&
                          gravity.x == m_gravity.x && gravity.y == m_gravity.y && gravity.z == m_gravity.z;
    if (asBefore) return m_isTooSoft;
    m_shape = fem.m_body.m_model->sharedShape();
    m_mass = mass;
    m_gravity = gravity;
    m_isTooSoft = weightStrain(fem) > kMaxWeightStrain;
    return m_isTooSoft;
}
