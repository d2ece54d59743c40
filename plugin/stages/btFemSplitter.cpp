// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemSplitter.h"

#include <memory>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/common/threads.h"
#include "fem/common/reason.h"
#include "plugin/setup/btFemBodySetUp.h"

using namespace bullet_fem;

namespace
{

// Creates the crack search of a body. Call before threads use it.
void readyForCracks(btFemBodyRecord& record)
{
    std::unique_ptr<btFemCracks>& cracks = record.m_model.m_cracks;
    const std::shared_ptr<const RestShape>& shape = record.fem().m_body.m_model->sharedShape();
    if (!cracks || cracks->m_fracture.shape() != shape) cracks = std::make_unique<btFemCracks>(shape);
}

// Number of connected components of elements, without loose nodes.
int partsOfMesh(const TetMesh& mesh)
{
    return mesh.componentCount() - mesh.looseCount();
}

btFemSplit splitOf(const btFemBodyRecord& record, const SplitMesh& mesh)
{
    btFemSplit split;
    split.m_body = record.m_softBody;
    split.m_cracks = static_cast<int>(mesh.m_cracks.size());
    double area = 0;
    for (const Crack& crack : mesh.m_cracks)
    {
        split.m_faces += crack.m_faces;
        area += crack.m_area;
    }
    split.m_area = static_cast<btScalar>(area);
    const Crack& first = mesh.m_cracks.front();
    split.m_place = bulletVector(first.m_place);
    split.m_normal = bulletVector(first.m_normal);
    split.m_stress = static_cast<btScalar>(first.m_stress);
    split.m_firstNode = record.m_softBody->m_nodes.size();
    split.m_copyOf = mesh.m_copyOf;
    split.m_firstFace = record.m_softBody->m_faces.size();
    return split;
}

}  // namespace

void btFemSplitter::split(btFemBodySetUp& setUp, const btFemRecords& records, const Threads& threads, double time)
{
    m_due.clear();
    for (const auto& record : records)
    {
        if (!(record->m_asked.m_strength.m_tension > 0) || !record->isStepped() || !record->m_softBody->isActive())
            continue;
        readyForCracks(*record);
        m_due.push_back(record.get());
    }
    if (m_due.empty()) return;
    threads.run(static_cast<int>(m_due.size()),
                [this](int k)
                {
                    const btFemTensileStrength& strength = m_due[k]->m_asked.m_strength;
                    btFemCracks& cracks = *m_due[k]->m_model.m_cracks;
                    cracks.m_found = cracks.m_fracture.find(
                        m_due[k]->fem().m_body, {strength.m_tension, strength.m_mostCracks}, cracks.m_split);
                });
    for (btFemBodyRecord* record : m_due)
        if (record->m_model.m_cracks->m_found) splitBody(setUp, *record, time);
}

void btFemSplitter::splitBody(btFemBodySetUp& setUp, btFemBodyRecord& record, double time)
{
    try
    {
        // indices are invalid after the split
        const std::unique_ptr<btFemCracks> cracks = std::move(record.m_model.m_cracks);
        btFemSplit event = splitOf(record, cracks->m_split);
        setUp.split(record, cracks->m_split);
        event.m_parts = partsOfMesh(record.fem().m_body.m_model->mesh());
        event.m_time = static_cast<btScalar>(time);
        if (event.m_parts > 1 && record.m_asked.m_strength.m_partsTouch)
        {
            record.m_softBody->m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
            setUp.readyForSelfContact(record);
        }
        record.m_softBody->activate();
        m_splits.push_back(event);
    }
    catch (const std::exception& error)  // the factor would be too large
    {
        record.m_model.m_message = reasonOf(error);
        record.m_model.m_flags |= BT_FEM_NOT_SPLIT;
        record.m_reports.m_step.m_flags |= BT_FEM_NOT_SPLIT;
        record.m_asked.m_strength = {};
    }
}
