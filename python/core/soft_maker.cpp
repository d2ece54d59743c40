// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/soft_maker.h"

#include <stdexcept>
#include <utility>

#include "bullet_fem/btFemHelpers.h"
#include "python/core/shared_bodies.h"
#include "tools/scene/scene_world_materials.h"

namespace bullet_fem::python
{
namespace
{

void useBaked(World& world, SoftEntry& entry, const BakedBody& baked)
{
    entry.m_own.reset(btFemHelpers::createFromBaked(world.bullet().info(), baked));
    world.fem().useBaked(entry.m_own.get(), baked);
    for (int node = 0; node < entry.m_own->m_nodes.size(); ++node)
        if (entry.m_own->m_nodes[node].m_im == 0)
            entry.m_pinned.emplace(node, btScalar(1 / baked.m_inverseMass[std::size_t(node)]));
}

void makeBody(World& world, SoftEntry& entry, const SoftRequest& request)
{
    if (request.m_baked) return useBaked(world, entry, *request.m_baked);
    const Mesh& mesh = *request.m_mesh;
    if (const BakedBody* shared = SharedBodies::find(world, request)) return useBaked(world, entry, *shared);
    // A cage is baked in memory, because that keeps its filled fractions and the surface in it.
    if (mesh.m_cage)
        return useBaked(world, entry, bakeBody(*mesh.m_cage, mesh.m_surface, bakeSettings(world, request)));
    entry.m_own.reset(btFemHelpers::createFromTetMesh(world.bullet().info(), mesh.m_tets));
}

void place(btSoftBody& body, const SoftRequest& request)
{
    body.transform(request.m_pose);
    btFemHelpers::updateEmbeddedSurface(&body);
    body.m_cfg.kDF = btScalar(request.m_friction);
    body.setRestitution(btScalar(request.m_restitution));
    if (request.m_selfContact) body.m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
    body.setVelocity(request.m_velocity);
}

}  // namespace

BakeSettings bakeSettings(const World& world, const SoftRequest& request)
{
    const ElementMaterials& materials = request.m_materials;
    BakeSettings settings;
    settings.m_material = materials.m_base;
    settings.m_labels = materials.m_labels;
    settings.m_regionMaterials = materials.m_ofLabel;
    settings.m_step = world.stepSize();
    settings.m_pins = request.m_pins;
    settings.m_singlePrecision = false;
    return settings;
}

int addSoft(World& world, const SoftRequest& request)
{
    auto entry = std::make_unique<SoftEntry>();
    try
    {
        makeBody(world, *entry, request);
        btSoftBody* body = entry->m_body = entry->m_own.get();
        entry->m_turn = request.m_pose.getBasis();
        const bool isBaked = request.m_baked || request.m_mesh->m_cage || SharedBodies::find(world, request);
        const bool isBakedWhole = isBaked && (request.m_materials.isOne() || !request.m_materials.m_labels.empty());
        if (!request.m_baked && !isBakedWhole) setMaterials(world, *entry, request.m_materials);
        setPins(*entry, request.m_pins);
        place(*body, request);
        world.fem().setContactOffset(body, btScalar(request.m_contactOffset));
        return world.add(std::move(entry), request.m_name, request.m_group, request.m_mask);
    }
    catch (...)
    {
        if (entry->m_own) world.fem().forget(entry->m_own.get());
        throw;
    }
}

void setPins(SoftEntry& entry, const std::vector<int>& nodes)
{
    btSoftBody& body = *entry.m_body;
    for (const int node : nodes)
    {
        if (node >= body.m_nodes.size())
            throw std::out_of_range("pins has node " + std::to_string(node) + ": the body has " +
                                    std::to_string(body.m_nodes.size()) + " nodes");
        if (body.m_nodes[node].m_im > 0) entry.m_pinned[node] = body.getMass(node);
        body.setMass(node, 0);
    }
}

void setMaterials(World& world, SoftEntry& body, const ElementMaterials& materials)
{
    if (materials.isOne())
    {
        materials.m_base.validate();
        world.fem().setMaterial(body.m_body, materialOf(turned(materials.m_base, body.m_turn)));
        return;
    }
    world.fem().setMaterials(body.m_body, materials.expand(body.m_body->m_tetras.size(), body.m_turn));
}

}  // namespace bullet_fem::python
