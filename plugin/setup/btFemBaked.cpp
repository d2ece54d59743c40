// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/setup/btFemBaked.h"

#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/rest_positions.h"
#include "bullet_fem/fem/baked/baked_body.h"
#include "fem/common/byte_stream.h"
#include "plugin/registry/btFemBodyRegistry.h"

using namespace bullet_fem;

namespace
{

// Hash of the rest matrices, which initializeDmInverse and scale set.
std::uint64_t markOfRestMatrices(const btSoftBody& body)
{
    std::uint64_t mark = kEmptyMark;
    for (int e = 0; e < body.m_tetras.size(); ++e)
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) addToMark(mark, body.m_tetras[e].m_Dm_inverse[r][c]);
    return mark;
}

bool hasElementsOf(const btSoftBody& body, const BodyModel& model)
{
    return hasElements(body, model.nodeCount(), model.mesh().tets());
}

}  // namespace

void useBaked(btFemBodyRegistry& registry, btSoftBody* body, const BakedBody& baked)
{
    if (!baked.m_model) reject("useBaked: the baked body is empty; read it with readBakedBody");
    if (!body) reject("useBaked: the soft body is null; make it with btFemHelpers::createFromBaked");
    if (!hasElementsOf(*body, *baked.m_model))
        reject("useBaked: the soft body has ", body->m_nodes.size(), " nodes and ", body->m_tetras.size(),
               " tetrahedra, and the baked one ", baked.m_model->nodeCount(), " and ", baked.m_model->mesh().tetCount(),
               ", or they join other nodes; make it with createFromBaked");
    btFemBodyRecord& record = registry.record(body);
    btFemBodyRecord ready(body);
    ready.m_membership.m_world = record.m_membership.m_world;
    ready.m_asked.m_detail = record.m_asked.m_detail;
    ready.m_asked.m_contactOffset = record.m_asked.m_contactOffset;
    ready.m_asked.m_materials = baked.m_model->shape().m_materials;
    ready.m_asked.m_materialGiven = true;
    ready.m_asked.m_baked = std::make_shared<const btFemBaked>(btFemBaked{baked.m_model, markOfRestMatrices(*body)});
    record = std::move(ready);
}

bool isAsBaked(const btSoftBody& body, const btFemBaked& baked)
{
    return hasElementsOf(body, *baked.m_model) && markOfRestMatrices(body) == baked.m_restMark;
}
