// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/shared_bodies.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace bullet_fem::python
{
namespace
{

bool areEqual(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Vec3& p, const Vec3& q) { return p.x == q.x && p.y == q.y && p.z == q.z; });
}

bool areEqual(const BakeSettings& a, const BakeSettings& b)
{
    return a.m_material == b.m_material && a.m_labels == b.m_labels && a.m_regionMaterials == b.m_regionMaterials &&
           a.m_step == b.m_step && a.m_pins == b.m_pins;
}

}  // namespace

SharedBodies* SharedBodies::s_present = nullptr;

SharedBodies::SharedBodies()
{
    if (s_present) throw std::runtime_error("a Batch is being built, and its builder must not build another");
    s_present = this;
}

SharedBodies::~SharedBodies()
{
    s_present = nullptr;
}

const BakedBody* SharedBodies::find(const World& world, const SoftRequest& request)
{
    const ElementMaterials& materials = request.m_materials;
    if (!s_present || !request.m_mesh || !(materials.isOne() || !materials.m_labels.empty())) return nullptr;
    return s_present->baked(request, bakeSettings(world, request));
}

const BakedBody* SharedBodies::baked(const SoftRequest& request, BakeSettings settings)
{
    const Mesh& mesh = *request.m_mesh;
    const auto& positions = mesh.m_tets.restPositions();
    const auto& tets = mesh.m_tets.tets();
    for (const auto& entry : m_entries)
        if (entry->m_isCage == (mesh.m_cage != nullptr) && areEqual(entry->m_positions, positions) &&
            entry->m_tets == tets && areEqual(entry->m_settings, settings))
            return &entry->m_baked;
    auto entry = std::make_unique<Entry>();
    entry->m_baked = mesh.m_cage ? bakeBody(*mesh.m_cage, mesh.m_surface, settings) : bakeBody(mesh.m_tets, settings);
    entry->m_positions = positions;
    entry->m_tets = tets;
    entry->m_isCage = mesh.m_cage != nullptr;
    entry->m_settings = std::move(settings);
    m_entries.push_back(std::move(entry));
    return &m_entries.back()->m_baked;
}

}  // namespace bullet_fem::python
