// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/bodies/btFemBodyRegistry.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body_arrays.h"
#include "bullet_bridge/body_mark.h"
#include "bullet_bridge/face_tree.h"
#include "bullet_bridge/node_exchange.h"
#include "bullet_bridge/soft_body_mesh.h"
#include "bullet_fem/fem/common/threads.h"
#include "bullet_fem/fem/step/body_snapshot.h"
#include "plugin/bodies/btFemDefinition.h"

using namespace bullet_fem;

namespace
{

constexpr int kInTwoWorlds = 2;  // claims of a body by its former world that two living worlds alone can make

FactorChoice coreChoice(btFemFactorChoice choice)
{
    if (choice == btFemFactorChoice::lowMemoryBeyond) return FactorChoice::lowMemoryBeyond;
    return choice == btFemFactorChoice::lowMemory ? FactorChoice::lowMemory : FactorChoice::full;
}

}  // namespace

Material materialOf(const btFemEntry& entry)
{
    return entry.m_materialGiven ? entry.m_material : unsetMaterialOf(*entry.m_softBody);
}

std::vector<double> massesAtRest(const btFemEntry& entry, double density)
{
    const btSoftBody& body = *entry.m_softBody;
    const bool known = entry.m_fem && !restMatricesChanged(*entry.m_fem);
    const TetMesh mesh = known ? entry.m_fem->m_body.m_model->mesh() : tetMeshOf(body);
    return lumpedMasses(mesh, filledFractionsOf(body), density * massScaleOf(body));
}

std::size_t btFemBodyRegistry::indexOf(const btSoftBody* body) const
{
    const auto at = m_number.find(body);
    return at == m_number.end() ? m_entries.size() : at->second;
}

// After every change of their order.
void btFemBodyRegistry::numberEntries()
{
    m_number.clear();
    for (std::size_t k = 0; k < m_entries.size(); ++k) m_number[m_entries[k]->m_softBody] = k;
}

btFemBodyRegistry::btFemBodyRegistry(const btFemSolverInfo& info)
    : m_showsManifolds(info.m_manifolds),
      m_library(static_cast<std::size_t>(1e6 * info.m_maxFactorMegabytes), coreChoice(info.m_factorChoice))
{
}

btFemEntry* btFemBodyRegistry::find(const btSoftBody* body)
{
    const std::size_t k = indexOf(body);
    return k < m_entries.size() ? m_entries[k].get() : nullptr;
}

btFemEntry& btFemBodyRegistry::entry(btSoftBody* body)
{
    if (!body)
        throw std::invalid_argument("the soft body is null; give a body made by btFemHelpers or btSoftBodyHelpers");
    const std::size_t known = indexOf(body);
    if (known < m_entries.size() && isAnother(known, *body))
        forget(body);
    else if (known < m_entries.size())
    {
        btFemEntry& entry = *m_entries[known];
        if (entry.m_fem) followNodes(*entry.m_fem);
        lookAgain(entry, entry.m_fem && topologyAsSetUp(*entry.m_fem));
        return entry;
    }
    m_entries.push_back(std::make_unique<btFemEntry>(body));
    m_number[body] = m_entries.size() - 1;
    return *m_entries.back();
}

void btFemBodyRegistry::forget(const btSoftBody* body)
{
    m_entries.erase(std::remove_if(m_entries.begin(), m_entries.end(),
                                   [body](const auto& entry) { return entry->m_softBody == body; }),
                    m_entries.end());
    numberEntries();
}

bool btFemBodyRegistry::isAsBuilt(const btFemEntry& entry)
{
    return !entry.m_fem || (hasMark(*entry.m_softBody, entry.m_fem->m_mark) && topologyAsSetUp(*entry.m_fem));
}

// True if another body lives now at the address of one that is known.
bool btFemBodyRegistry::isAnother(std::size_t known, const btSoftBody& body) const
{
    const std::unique_ptr<FemSoftBody>& fem = m_entries[known]->m_fem;
    return fem && !hasMark(body, fem->m_mark);
}

// Bodies at such addresses are new, and come last, as they would at any others: the order of bodies decides about
// rounding.
void btFemBodyRegistry::forgetTheDead(const btAlignedObjectArray<btSoftBody*>& softBodies)
{
    for (int i = 0; i < softBodies.size(); ++i)
    {
        const std::size_t known = indexOf(softBodies[i]);
        if (known < m_entries.size() && isAnother(known, *softBodies[i])) forget(softBodies[i]);
    }
}

// Nodes or tetrahedra may have been appended, removed, or joined otherwise: then the body keeps what the user asked for
// it.
void btFemBodyRegistry::lookAgain(btFemEntry& entry, bool joinedAsBefore)
{
    if (!entry.m_fem || joinedAsBefore) return;
    btFemEntry changed(entry.m_softBody);
    changed.m_world = entry.m_world;
    changed.m_material = entry.m_material;
    changed.m_materialGiven = entry.m_materialGiven;
    changed.m_detail = entry.m_detail;
    changed.m_contactOffset = entry.m_contactOffset;
    changed.m_wasChanged = true;
    entry.m_softBody->activate();
    entry = std::move(changed);
}

// A world that holds a body of another one takes it over. Worlds that take it from each other both hold it; once may be
// a new world at the address of a deleted one.
void btFemBodyRegistry::claim(btFemEntry& entry, const void* world, const btSoftBodySolver* solver)
{
    if (entry.m_world && entry.m_world != world && entry.m_handedBack < kInTwoWorlds)
    {
        entry.m_handedBack = entry.m_formerWorld == world ? entry.m_handedBack + 1 : 0;
        entry.m_formerWorld = entry.m_world;
        entry.m_world = world;
    }
    if (!entry.m_world) entry.m_world = world;
    const bool otherSolver = entry.m_softBody->getSoftBodySolver() != solver;
    if (entry.m_handedBack >= kInTwoWorlds || otherSolver) entry.m_report.m_flags |= BT_FEM_OTHER_WORLD;
    entry.m_present = entry.m_world == world && !otherSolver;
}

// Every tetrahedron of every body is looked at, which takes longer than all else here.
void btFemBodyRegistry::compareTopologies(const btAlignedObjectArray<btSoftBody*>& softBodies, const Threads& threads)
{
    m_joinedAsBefore.assign(m_entries.size(), 0);
    m_compared.clear();
    for (int i = 0; i < softBodies.size(); ++i)
    {
        const std::size_t known = indexOf(softBodies[i]);
        if (known == m_entries.size() || m_joinedAsBefore[known] || !m_entries[known]->m_fem) continue;
        followNodes(*m_entries[known]->m_fem);
        m_joinedAsBefore[known] = 1;
        m_compared.push_back(static_cast<int>(known));
    }
    threads.run(static_cast<int>(m_compared.size()),
                [this](int k)
                {
                    const int known = m_compared[k];
                    m_joinedAsBefore[known] = topologyInTurnAsSetUp(*m_entries[known]->m_fem);
                });
}

void btFemBodyRegistry::synchronise(const btAlignedObjectArray<btSoftBody*>& softBodies, const btSoftBodySolver* solver,
                                    const Threads& threads)
{
    forgetTheDead(softBodies);
    compareTopologies(softBodies, threads);
    const void* world = &softBodies;
    m_held.assign(m_entries.size(), 0);
    for (const auto& entry : m_entries)
    {
        entry->m_present = false;
        entry->m_report.m_flags = 0;
    }
    for (int i = 0; i < softBodies.size(); ++i)
    {
        btSoftBody* soft = softBodies[i];
        std::size_t known = indexOf(soft);
        if (known < m_entries.size() && m_held[known])
        {
            m_entries[known]->m_report.m_flags |= BT_FEM_ADDED_TWICE;
            continue;
        }
        if (known < m_entries.size()) lookAgain(*m_entries[known], m_joinedAsBefore[known] != 0);
        if (known == m_entries.size() && soft->m_tetras.size() == 0) continue;
        if (known == m_entries.size())
        {
            entry(soft);
            m_held.push_back(0);
        }
        m_held[known] = 1;
        claim(*m_entries[known], world, solver);
    }
    // What this world, or none, has and the world does not hold is gone, and must not be looked at.
    std::size_t kept = 0;
    for (std::size_t k = 0; k < m_entries.size(); ++k)
    {
        const bool gone = !m_held[k] && (m_entries[k]->m_world == world || !m_entries[k]->m_world);
        if (!gone) std::swap(m_entries[kept++], m_entries[k]);
    }
    if (kept == m_entries.size()) return;
    m_entries.resize(kept);
    numberEntries();
}

bool btFemBodyRegistry::worldHolds(const btSoftBody& body, const btCollisionObject* object)
{
    m_worldObjects.read(body);
    return m_worldObjects.holds(body, object);
}

bool btFemBodyRegistry::readWorld(const std::vector<btFemEntry*>& entries)
{
    if (!entries.empty()) m_worldObjects.read(*entries.front()->m_softBody);
    return std::all_of(entries.begin(), entries.end(),
                       [this](const btFemEntry* entry) { return m_worldObjects.hasRead(*entry->m_softBody); });
}

FactorInput btFemBodyRegistry::factorInput(const btFemEntry& entry, double step) const
{
    FactorInput input;
    input.m_mass = entry.m_fem->m_body.m_state.m_mass;
    input.m_fixed = entry.m_fem->m_body.m_state.m_fixed;
    input.m_step = step;
    return m_library.limited(std::move(input));
}

bool btFemBodyRegistry::knowsFactor(const btFemEntry& entry, double step) const
{
    return m_library.find(entry.m_fem->m_body.m_model->sharedShape(), factorInput(entry, step)) != nullptr;
}

void btFemBodyRegistry::refactor(btFemEntry& entry, double step)
{
    exchangeModel(entry, m_library.model(entry.m_fem->m_body.m_model->sharedShape(), factorInput(entry, step)));
}

bool btFemBodyRegistry::tryRefactor(btFemEntry& entry, double step)
{
    try
    {
        refactor(entry, step);
        entry.m_message.clear();
        entry.m_report.m_flags |= BT_FEM_REFACTORED;
        return true;
    }
    catch (const std::exception& error)
    {
        entry.m_message = error.what();
        return false;
    }
}

void btFemBodyRegistry::takeFactor(btFemEntry& entry, const std::shared_ptr<const BodyModel>& model)
{
    exchangeModel(entry, m_library.adopt(model));
    entry.m_message.clear();
    entry.m_report.m_flags |= BT_FEM_REFACTORED;
}

std::shared_ptr<const RestShape> btFemBodyRegistry::shapeOf(const btFemEntry& entry, std::uint64_t mark)
{
    const BodyModel& model = *entry.m_fem->m_body.m_model;
    if (markOf(model.shape()) == mark) return model.sharedShape();
    const auto shape = m_library.restShape(model.mesh(), materialOf(entry), filledFractionsOf(*entry.m_softBody));
    return markOf(*shape) == mark ? shape : nullptr;
}

std::shared_ptr<const BodyModel> btFemBodyRegistry::exactModel(const btFemEntry& entry,
                                                               const std::shared_ptr<const RestShape>& shape,
                                                               const FactorInput& input)
{
    const std::shared_ptr<const BodyModel>& own = entry.m_fem->m_body.m_model;
    if (own->sharedShape() == shape && own->factorInput() == input) return own;
    return m_library.exactModel(shape, input);
}

void btFemBodyRegistry::giveFactors(btFemEntry& entry, const std::shared_ptr<const BodyModel>& model,
                                    const std::shared_ptr<const BodyModel>& former)
{
    exchangeModel(entry, model);
    entry.m_formerModel = former;
    entry.m_formerCompliance = former ? m_library.compliance(former, entry.m_fem->m_skin.get()) : nullptr;
}

void btFemBodyRegistry::putFirst(const std::vector<btFemEntry*>& entries)
{
    const auto place = [&entries](const std::unique_ptr<btFemEntry>& entry)
    { return std::find(entries.begin(), entries.end(), entry.get()); };
    std::stable_sort(m_entries.begin(), m_entries.end(),
                     [&place](const auto& a, const auto& b) { return place(a) < place(b); });
    numberEntries();
}

void btFemBodyRegistry::exchangeModel(btFemEntry& entry, const std::shared_ptr<const BodyModel>& model)
{
    FemSoftBody& fem = *entry.m_fem;
    if (model == fem.m_body.m_model) return;
    entry.m_formerModel = fem.m_body.m_model;
    entry.m_formerCompliance = fem.m_compliance;
    fem.m_body.setModel(model);
    fem.m_compliance = m_library.compliance(model, fem.m_skin.get());
}
