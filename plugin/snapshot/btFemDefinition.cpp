// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/snapshot/btFemDefinition.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/rest_positions.h"
#include "bullet_bridge/body/soft_body_mesh.h"
#include "bullet_fem/fem/body/body_snapshot.h"
#include "plugin/registry/btFemBodyRegistry.h"
#include "plugin/setup/btFemBodySetUp.h"
#include "plugin/snapshot/btFemEnvelope.h"

using namespace bullet_fem;

namespace
{

template <class Bytes>
void transfer(Bytes& bytes, btFemDefinition& d)
{
    bytes(d.m_restPositions, d.m_restOrigin, d.m_tets, d.m_filled, d.m_massScale, d.m_materials, d.m_mass,
          d.m_inverseMass, d.m_contactOffset, d.m_detail);
}

// The definition of a FEM body; of another body, that which it would get now.
btFemDefinition definitionOf(const btFemBodyRegistry& registry, const btSoftBody& soft)
{
    const btFemBodyRecord* record = registry.find(&soft);
    if (record && record->isFem() && !btFemBodyRegistry::isAsBuilt(*record)) record = nullptr;  // it was cut
    const std::shared_ptr<const btFemDefinition> asked =
        record && !record->isFem() ? record->m_asked.m_definition : nullptr;
    if (asked && hasElements(soft, asked->m_restPositions.size(), asked->m_tets)) return *asked;
    btFemDefinition d;
    d.m_tets = tetsOf(soft);
    d.m_filled = filledFractionsOf(soft);
    d.m_massScale = massScaleOf(soft);
    const bool fem = record && record->isFem();
    d.m_materials = record && record->m_asked.m_materialGiven ? record->m_asked.m_materials
                    : fem                                     ? record->fem().m_body.m_model->shape().m_materials
                                                              : unsetMaterialOf(soft);
    if (record) d.m_contactOffset = record->m_asked.m_contactOffset, d.m_detail = record->m_asked.m_detail;
    for (int i = 0; i < soft.m_nodes.size(); ++i) d.m_inverseMass.push_back(soft.m_nodes[i].m_im);
    if (fem)
    {
        d.m_restPositions = record->fem().m_body.m_model->mesh().restPositions();
        d.m_restOrigin = record->fem().m_setUp.m_restOrigin;
        d.m_mass = record->fem().m_body.m_state.m_mass;
        return d;
    }
    const RestMesh rest = restMeshOf(soft);
    bool repaired = false;
    d.m_restPositions = rest.m_mesh.restPositions();
    d.m_restOrigin = rest.m_origin;
    d.m_mass = sanitisedMasses(soft, lumpedMasses(rest.m_mesh, d.m_filled, 1), repaired);
    return d;
}

void checkNumbers(const btFemDefinition& d)
{
    for (std::size_t i = 0; i < d.m_mass.size(); ++i)
        if (!(d.m_mass[i] > 0) || !std::isfinite(d.m_mass[i]))
            reject("the mass of node ", i, " is ", d.m_mass[i], " kg, not in (0, inf)");
    for (const double filled : d.m_filled)
        if (!(filled > 0 && filled <= 1)) reject("the filled fraction ", filled, " of an element is not in (0, 1]");
    if (!(d.m_massScale > 0) || !std::isfinite(d.m_massScale))
        reject("the mass scale is ", d.m_massScale, ", not in (0, inf)");
    if (!isFinite(d.m_restOrigin)) reject("the rest shape's place is not finite");
    if (!(d.m_contactOffset >= 0 && d.m_contactOffset <= 1000))
        reject("the contact offset ", d.m_contactOffset, " m is not in [0, 1000]");
    if (d.m_detail < btFemDetail::nodalWarp || d.m_detail > btFemDetail::automatic)
        reject("the detail is ", static_cast<int>(d.m_detail), ", not in [0, 4]");
}

void check(const btFemDefinition& d, const btSoftBody& soft)
{
    const std::size_t n = soft.m_nodes.size();
    if (d.m_restPositions.size() != n || d.m_tets.size() != static_cast<std::size_t>(soft.m_tetras.size()))
        reject("it has ", d.m_restPositions.size(), " nodes and ", d.m_tets.size(), " tetrahedra, and the body ", n,
               " and ", soft.m_tetras.size());
    if (d.m_tets != tetsOf(soft)) reject("its tetrahedra join other nodes than the body's");
    if (d.m_mass.size() != n || d.m_inverseMass.size() != n ||
        (!d.m_filled.empty() && d.m_filled.size() != d.m_tets.size()))
        reject("it has ", d.m_mass.size(), " masses, ", d.m_inverseMass.size(), " inverse masses and ",
               d.m_filled.size(), " filled fractions");
    checkNumbers(d);
    d.m_materials.validate(soft.m_tetras.size());
    TetMesh(d.m_restPositions, d.m_tets, LooseNodes::kept);  // throws if it is not a valid mesh
}

}  // namespace

void saveDefinition(const btFemBodyRegistry& registry, const btSoftBody* body, std::vector<unsigned char>& buffer)
{
    std::string why;
    if (!canBecomeFem(body, why)) reject(why);
    btFemDefinition definition = definitionOf(registry, *body);
    beginEnvelope(buffer, btFemContents::definition);
    ByteWriter bytes(buffer);
    transfer(bytes, definition);
    closeEnvelope(buffer);
}

void applyDefinition(btFemBodyRegistry& registry, btSoftBody* body, const unsigned char* data, std::size_t size)
{
    if (!body || body->m_nodes.size() == 0 || body->m_tetras.size() == 0)
        reject("the soft body is null or has no tetrahedra");
    auto definition = std::make_shared<btFemDefinition>();
    ByteReader bytes = openEnvelope(data, size, btFemContents::definition);
    transfer(bytes, *definition);
    if (bytes.left() > 0) reject("it has ", bytes.left(), " bytes too many");
    check(*definition, *body);

    for (std::size_t e = 0; e < definition->m_filled.size(); ++e)
        storeFill(*body, static_cast<int>(e), definition->m_filled[e], definition->m_massScale);
    for (int i = 0; i < body->m_nodes.size(); ++i) body->m_nodes[i].m_im = definition->m_inverseMass[i];
    body->m_bUpdateRtCst = true;
    registry.forget(body);
    btFemBodyRecord& record = registry.record(body);
    record.m_asked.m_materials = definition->m_materials;
    record.m_asked.m_materialGiven = true;
    record.m_asked.m_contactOffset = definition->m_contactOffset;
    record.m_asked.m_detail = definition->m_detail;
    record.m_asked.m_definition = std::move(definition);
}
