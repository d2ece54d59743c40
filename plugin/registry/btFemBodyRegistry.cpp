// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/registry/btFemBodyRegistry.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/body_arrays.h"
#include "bullet_bridge/body/body_mark.h"
#include "bullet_bridge/joints/cluster_joints.h"
#include "bullet_fem/fem/common/threads.h"
#include "plugin/registry/btFemBroadphaseProxy.h"

using namespace bullet_fem;

namespace
{

constexpr int kInTwoWorlds = 2;  // mutual claims of a body that only two living worlds can make

// True if both arrays have the same bodies in the same order.
bool areSame(const btAlignedObjectArray<btSoftBody*>& a, const btAlignedObjectArray<btSoftBody*>& b)
{
    bool same = a.size() == b.size();
    for (int i = 0; i < a.size() && same; ++i) same = a[i] == b[i];
    return same;
}

}  // namespace

// Records are usually in the order of the world's bodies, so that `place` in one is that in the other.
std::size_t btFemBodyRegistry::indexOf(const btSoftBody* body, int place) const
{
    const auto k = static_cast<std::size_t>(place);
    return k < m_records.size() && m_records[k]->m_softBody == body ? k : indexOf(body);
}

std::size_t btFemBodyRegistry::indexOf(const btSoftBody* body) const
{
    const auto at = m_number.find(body);
    return at == m_number.end() ? m_records.size() : at->second;
}

// Updates the index of records. Call after each change of their order.
void btFemBodyRegistry::numberRecords()
{
    m_number.clear();
    for (std::size_t k = 0; k < m_records.size(); ++k) m_number[m_records[k]->m_softBody] = k;
}

btFemBodyRecord* btFemBodyRegistry::find(const btSoftBody* body) const
{
    const std::size_t k = indexOf(body);
    return k < m_records.size() && !isAnother(k, *body) ? m_records[k].get() : nullptr;
}

btFemBodyRecord& btFemBodyRegistry::record(btSoftBody* body)
{
    if (!body)
        throw std::invalid_argument("the soft body is null; give a body made by btFemHelpers or btSoftBodyHelpers");
    const std::size_t known = indexOf(body);
    if (known < m_records.size() && isAnother(known, *body))
        forget(body);
    else if (known < m_records.size())
    {
        btFemBodyRecord& record = *m_records[known];
        if (record.isFem()) followNodes(record.fem());
        lookAgain(record, record.isFem() && topologyAsSetUp(record.fem()));
        return record;
    }
    m_records.push_back(std::make_unique<btFemBodyRecord>(body));
    m_number[body] = m_records.size() - 1;
    return *m_records.back();
}

void btFemBodyRegistry::forget(const btSoftBody* body)
{
    m_records.erase(std::remove_if(m_records.begin(), m_records.end(),
                                   [body](const auto& record) { return record->m_softBody == body; }),
                    m_records.end());
    numberRecords();
}

bool btFemBodyRegistry::isAsBuilt(const btFemBodyRecord& record)
{
    return !record.isFem() ||
           (hasMark(*record.m_softBody, record.fem().m_setUp.m_mark) && topologyAsSetUp(record.fem()));
}

// True if another body is now at the address of a known one.
bool btFemBodyRegistry::isAnother(std::size_t known, const btSoftBody& body) const
{
    const btFemBodyRecord& record = *m_records[known];
    return record.isFem() && !hasMark(body, record.fem().m_setUp.m_mark);
}

// Forgets bodies whose address was reused. The new body gets a record at the end, as at any other address: the order of
// bodies affects rounding.
void btFemBodyRegistry::forgetTheDead(const btAlignedObjectArray<btSoftBody*>& softBodies)
{
    for (int i = 0; i < softBodies.size(); ++i)
    {
        const std::size_t known = indexOf(softBodies[i], i);
        if (known < m_records.size() && isAnother(known, *softBodies[i])) forget(softBodies[i]);
    }
}

// Makes a body of changed nodes or tetrahedra a new record, which keeps the user's settings.
void btFemBodyRegistry::lookAgain(btFemBodyRecord& record, bool joinedAsBefore)
{
    if (!record.isFem() || joinedAsBefore) return;
    btFemBodyRecord changed(record.m_softBody);
    changed.m_membership.m_world = record.m_membership.m_world;
    changed.m_asked.m_materials = record.m_asked.m_materials;
    changed.m_asked.m_materialGiven = record.m_asked.m_materialGiven;
    changed.m_asked.m_detail = record.m_asked.m_detail;
    changed.m_asked.m_contactOffset = record.m_asked.m_contactOffset;
    changed.m_asked.m_strength = record.m_asked.m_strength;
    changed.m_model.m_wasChanged = true;
    record.m_softBody->activate();
    record = std::move(changed);
}

// A world takes over a body that another world had. A body that goes back and forth is in two worlds at once; a single
// return may be a new world at the address of a deleted one.
void btFemBodyRegistry::claim(btFemBodyRecord& record, const void* world, const btSoftBodySolver* solver)
{
    if (record.m_membership.m_world && record.m_membership.m_world != world &&
        record.m_membership.m_handedBack < kInTwoWorlds)
    {
        record.m_membership.m_handedBack =
            record.m_membership.m_formerWorld == world ? record.m_membership.m_handedBack + 1 : 0;
        record.m_membership.m_formerWorld = record.m_membership.m_world;
        record.m_membership.m_world = world;
    }
    if (!record.m_membership.m_world) record.m_membership.m_world = world;
    const bool otherSolver = record.m_softBody->getSoftBodySolver() != solver;
    if (record.m_membership.m_handedBack >= kInTwoWorlds || otherSolver)
        record.m_reports.m_step.m_flags |= BT_FEM_OTHER_WORLD;
    record.m_membership.m_present = record.m_membership.m_world == world && !otherSolver;
}

// Compares tetrahedra with the known topology on several threads: this is the costliest part of synchronise().
void btFemBodyRegistry::compareTopologies(const btAlignedObjectArray<btSoftBody*>& softBodies, const Threads& threads)
{
    m_joinedAsBefore.assign(m_records.size(), 0);
    m_compared.clear();
    for (int i = 0; i < softBodies.size(); ++i)
    {
        const std::size_t known = indexOf(softBodies[i], i);
        if (known == m_records.size() || m_joinedAsBefore[known] || !m_records[known]->isFem()) continue;
        followNodes(m_records[known]->fem());
        m_joinedAsBefore[known] = 1;
        m_compared.push_back(static_cast<int>(known));
    }
    threads.run(static_cast<int>(m_compared.size()),
                [this](int k)
                {
                    const int known = m_compared[k];
                    m_joinedAsBefore[known] = topologyInTurnAsSetUp(m_records[known]->fem());
                });
}

void btFemBodyRegistry::synchronise(const btAlignedObjectArray<btSoftBody*>& softBodies, const btSoftBodySolver* solver,
                                    const Threads& threads)
{
    forgetTheDead(softBodies);
    compareTopologies(softBodies, threads);
    const void* world = &softBodies;
    m_held.assign(m_records.size(), 0);
    for (const auto& record : m_records)
    {
        record->m_membership.m_present = false;
        record->m_reports.m_step.m_flags = 0;
        record->m_work.m_sleep.m_enclosesObject = false;
    }
    for (int i = 0; i < softBodies.size(); ++i)
    {
        btSoftBody* soft = softBodies[i];
        std::size_t known = indexOf(soft, i);
        if (known < m_records.size() && m_held[known])
        {
            m_records[known]->m_reports.m_step.m_flags |= BT_FEM_ADDED_TWICE;
            restoreBroadphaseProxy(*soft);
            continue;
        }
        if (known < m_records.size()) lookAgain(*m_records[known], m_joinedAsBefore[known] != 0);
        if (known == m_records.size() && soft->m_tetras.size() == 0) continue;
        if (known == m_records.size())
        {
            record(soft);
            m_held.push_back(0);
        }
        m_held[known] = 1;
        if (!soft->getBroadphaseHandle()) restoreBroadphaseProxy(*soft);
        claim(*m_records[known], world, solver);
    }
    // Drops records of bodies that this world no longer contains. They may be deleted, so they must not be accessed.
    std::size_t kept = 0;
    for (std::size_t k = 0; k < m_records.size(); ++k)
    {
        const bool gone =
            !m_held[k] && (m_records[k]->m_membership.m_world == world || !m_records[k]->m_membership.m_world);
        if (!gone) std::swap(m_records[kept++], m_records[k]);
    }
    if (kept == m_records.size()) return;
    m_records.resize(kept);
    numberRecords();
}

void btFemBodyRegistry::dropRemoved(const btAlignedObjectArray<btSoftBody*>& held,
                                    btAlignedObjectArray<btSoftBody*>& stepped)
{
    const bool allHeld = areSame(stepped, held);  // thousands of bodies are not searched for one by one
    const auto isHeld = [&](btSoftBody* body) { return allHeld || held.findLinearSearch(body) < held.size(); };
    int kept = 0;
    for (int i = 0; i < stepped.size(); ++i)
        if (isHeld(stepped[i])) stepped[kept++] = stepped[i];
    stepped.resize(kept);
    for (const auto& record : m_records)
    {
        if (!record->m_membership.m_present) continue;
        const bool isThere = isHeld(record->m_softBody),
                   changed = isThere && record->isFem() && !arraysAsSetUp(record->fem());
        if (changed) showClusterJoints(record->fem());
        if (!isThere || changed) record->m_membership.m_present = false;
    }
}

void btFemBodyRegistry::putFirst(const std::vector<btFemBodyRecord*>& records)
{
    const auto place = [&records](const std::unique_ptr<btFemBodyRecord>& record)
    { return std::find(records.begin(), records.end(), record.get()); };
    std::stable_sort(m_records.begin(), m_records.end(),
                     [&place](const auto& a, const auto& b) { return place(a) < place(b); });
    numberRecords();
}
