// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/rest_modes.h"

#include <algorithm>
#include <cmath>

#include "fem/common/aligned_array.h"
#include "fem/factor/rest_factor.h"

namespace bullet_fem
{
namespace
{

// Maximum distance of fixed nodes from their line, relative to their extent.
constexpr double kCollinearShare = 1e-9;

// Power iterations for the smallest elastic eigenvalue. More do not change the iterations of conjugate gradients.
constexpr int kPowerIterations = 4;

Vec3 entry(const float* y, std::size_t node)
{
    return {y[3 * node], y[3 * node + 1], y[3 * node + 2]};
}

RestModes::Motion motionOf(const RestModes::Component& component, const RestModes::Motion& momentum)
{
    return {component.m_inverseMass * momentum.m_linear, component.m_inverseInertia * momentum.m_angular};
}

Vec3 velocityOf(const RestModes::Motion& motion, const RestModes::Node& node)
{
    return motion.m_linear + cross(motion.m_angular, node.m_lever);
}

void setEntry(const Vec3& v, float* y, std::size_t node)
{
    for (int i = 0; i < 3; ++i) y[3 * node + static_cast<std::size_t>(i)] = static_cast<float>(v[i]);
}

}  // namespace

RestModes::RestModes(const BodyModel& model) : m_model(model), m_components(model.mesh().componentCount())
{
    findCenters();
    const std::vector<int>& component = model.mesh().nodeComponent();
    const std::vector<Vec3>& X = model.mesh().restPositions();
    for (std::size_t i = 0; i < X.size(); ++i)
    {
        Component& rigid = m_components[component[i]];
        const Vec3 r = X[i] - rigid.m_center;
        rigid.m_inverseInertia += model.factorInput().m_mass[i] * (Mat3::diagonal(dot(r, r)) - outer(r, r));
    }
    for (Component& rigid : m_components)
        rigid.m_inverseInertia = trace(rigid.m_inverseInertia) > 0 ? inverse(rigid.m_inverseInertia) : Mat3();
    findAxes();
    m_any = std::any_of(m_components.begin(), m_components.end(), [](const Component& rigid) { return rigid.moves(); });
    if (!m_any) return;
    findNodes();
    findSoftness();
}

// Centre of mass, or any fixed node.
void RestModes::findCenters()
{
    const std::vector<int>& component = m_model.mesh().nodeComponent();
    const std::vector<Vec3>& X = m_model.mesh().restPositions();
    std::vector<double> mass(m_components.size());
    for (std::size_t i = 0; i < X.size(); ++i)
    {
        Component& rigid = m_components[component[i]];
        if (m_model.factor().position(static_cast<int>(i)) < 0 && rigid.m_fixed++ == 0) rigid.m_center = X[i];
        if (rigid.m_fixed > 0) continue;
        mass[component[i]] += m_model.factorInput().m_mass[i];
        rigid.m_center += m_model.factorInput().m_mass[i] * X[i];
    }
    for (std::size_t k = 0; k < m_components.size(); ++k)
    {
        if (m_components[k].m_fixed > 0) continue;
        m_components[k].m_inverseMass = 1 / mass[k];
        m_components[k].m_center *= 1 / mass[k];
    }
}

// Removes from the inverse inertia the rotations that several fixed nodes prevent.
void RestModes::findAxes()
{
    const std::vector<int>& component = m_model.mesh().nodeComponent();
    const std::vector<Vec3>& X = m_model.mesh().restPositions();
    std::vector<Vec3> axis(m_components.size());  // to the farthest fixed node
    const auto forEachFixed = [&](const auto& visit)
    {
        for (std::size_t i = 0; i < X.size(); ++i)
            if (m_model.factor().position(static_cast<int>(i)) < 0)
                visit(m_components[component[i]], axis[component[i]], X[i] - m_components[component[i]].m_center);
    };
    forEachFixed(
        [](const Component&, Vec3& a, const Vec3& r)
        {
            if (dot(r, r) > dot(a, a)) a = r;
        });
    for (std::size_t k = 0; k < m_components.size(); ++k)
    {
        if (!(dot(axis[k], axis[k]) > 0)) continue;
        const Vec3 a = (1 / norm(axis[k])) * axis[k];
        m_components[k].m_inverseInertia = (1 / dot(a, inverse(m_components[k].m_inverseInertia) * a)) * outer(a, a);
    }
    forEachFixed(
        [](Component& rigid, const Vec3& a, const Vec3& r)
        {
            if (norm(cross(a, r)) > kCollinearShare * dot(a, a)) rigid.m_inverseInertia = {};
        });
}

void RestModes::findNodes()
{
    m_nodes.resize(m_model.factor().freeNodeCount());
    for (int i = 0; i < m_model.nodeCount(); ++i)
    {
        const int position = m_model.factor().position(i), component = m_model.mesh().nodeComponent()[i];
        if (position < 0) continue;
        m_nodes[position] = {m_model.mesh().restPositions()[i] - m_components[component].m_center,
                             m_model.factorInput().m_mass[i], component};
    }
}

void RestModes::removeImpulses(float* y, std::vector<Motion>& motions) const
{
    std::fill(motions.begin(), motions.end(), Motion());
    for (std::size_t k = 0; k < m_nodes.size(); ++k)
    {
        Motion& sum = motions[m_nodes[k].m_component];
        const Vec3 impulse = entry(y, k);
        sum.m_linear += impulse;
        sum.m_angular += cross(m_nodes[k].m_lever, impulse);
    }
    for (std::size_t c = 0; c < m_components.size(); ++c) motions[c] = motionOf(m_components[c], motions[c]);
    for (std::size_t k = 0; k < m_nodes.size(); ++k)
        setEntry(entry(y, k) - m_nodes[k].m_mass * velocityOf(motions[m_nodes[k].m_component], m_nodes[k]), y, k);
}

void RestModes::replaceMotions(float* y, std::vector<Motion>& motions) const
{
    const std::size_t count = m_components.size();
    std::fill(motions.begin() + static_cast<std::ptrdiff_t>(count), motions.end(), Motion());
    for (std::size_t k = 0; k < m_nodes.size(); ++k)
    {
        Motion& sum = motions[count + m_nodes[k].m_component];
        const Vec3 momentum = m_nodes[k].m_mass * entry(y, k);
        sum.m_linear += momentum;
        sum.m_angular += cross(m_nodes[k].m_lever, momentum);
    }
    for (std::size_t c = 0; c < count; ++c)
    {
        const Motion found = motionOf(m_components[c], motions[count + c]);
        motions[c].m_linear = m_components[c].m_softness * motions[c].m_linear - found.m_linear;
        motions[c].m_angular = m_components[c].m_softness * motions[c].m_angular - found.m_angular;
    }
    for (std::size_t k = 0; k < m_nodes.size(); ++k)
        setEntry(entry(y, k) + velocityOf(motions[m_nodes[k].m_component], m_nodes[k]), y, k);
}

// Power iterations of A0^-1 M from a smooth field, which consists mostly of the softest bending and stretching modes.
void RestModes::findSoftness()
{
    const PackedFactor& factor = m_model.factor().lower();
    const AlignedFloats y = allocateFloats(factor.vectorSize()), scratch = allocateFloats(factor.scratchSize());
    std::vector<Motion> motions(2 * m_components.size());
    std::vector<double> before(m_components.size()), after(m_components.size());
    for (std::size_t k = 0; k < m_nodes.size(); ++k)
    {
        const Vec3& r = m_nodes[k].m_lever;
        setEntry({r.y * r.y + 0.5 * r.z * r.z + r.y * r.z, r.x * r.x + 0.5 * r.z * r.z - r.x * r.z,
                  0.5 * r.x * r.x + r.y * r.y + r.x * r.y},
                 y.get(), k);
    }
    const auto energies = [&](std::vector<double>& energy)
    {
        std::fill(energy.begin(), energy.end(), 0.0);
        for (std::size_t k = 0; k < m_nodes.size(); ++k)
            energy[m_nodes[k].m_component] += m_nodes[k].m_mass * dot(entry(y.get(), k), entry(y.get(), k));
    };
    for (int iteration = 0; iteration < kPowerIterations; ++iteration)
    {
        std::fill(motions.begin(), motions.end(), Motion());
        replaceMotions(y.get(), motions);
        energies(before);
        for (std::size_t k = 0; k < m_nodes.size(); ++k)
        {
            const double energy = before[m_nodes[k].m_component];
            setEntry((energy > 0 ? m_nodes[k].m_mass / std::sqrt(energy) : 0.0) * entry(y.get(), k), y.get(), k);
        }
        factor.solve(y.get(), scratch.get());
        replaceMotions(y.get(), motions);
        energies(after);
    }
    for (std::size_t c = 0; c < m_components.size(); ++c)
        if (std::isfinite(after[c])) m_components[c].m_softness = std::sqrt(after[c]);
}

Mat3 RestModes::response(int i, int j) const
{
    const int c = m_model.mesh().nodeComponent()[i];
    if (m_model.mesh().nodeComponent()[j] != c || m_model.factor().position(i) < 0 || m_model.factor().position(j) < 0)
        return {};
    const Component& component = m_components[c];
    const std::vector<Vec3>& X = m_model.mesh().restPositions();
    const Mat3 ri = crossMatrix(X[i] - component.m_center), rj = crossMatrix(X[j] - component.m_center);
    const double damped = 1 + m_model.factorInput().m_step * m_model.shape().m_material.m_massDamping;
    return (1 / damped) * (Mat3::diagonal(component.m_inverseMass) + transpose(ri) * component.m_inverseInertia * rj);
}

}  // namespace bullet_fem
