// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/btFemBodyRegistry.h"

#include <algorithm>
#include <stdexcept>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body_arrays.h"
#include "bullet_bridge/body_mark.h"
#include "bullet_bridge/face_tree.h"
#include "bullet_bridge/node_exchange.h"
#include "bullet_bridge/shapes/rigid_dispatch.h"
#include "bullet_bridge/soft_body_mesh.h"
#include "fem/body_snapshot.h"
#include "plugin/btFemContactTest.h"
#include "plugin/btFemDefinition.h"
#include "plugin/btFemManifolds.h"

using namespace bullet_fem;

namespace
{

constexpr int kInTwoWorlds = 2;  // claims of a body by its former world that two living worlds alone can make

FactorChoice coreChoice(btFemFactorChoice choice)
{
    if (choice == btFemFactorChoice::lowMemoryBeyond) return FactorChoice::lowMemoryBeyond;
    return choice == btFemFactorChoice::lowMemory ? FactorChoice::lowMemory : FactorChoice::full;
}

Material materialOf(const btFemEntry& entry)
{
    return entry.m_materialGiven ? entry.m_material : unsetMaterialOf(*entry.m_softBody);
}

int flagsOf(const TetMesh& mesh)
{
    return (mesh.turnedCount() > 0 ? BT_FEM_TURNED_TETS : 0) |
           (mesh.componentCount() - mesh.looseCount() > 1 ? BT_FEM_SEVERAL_PIECES : 0) |
           (mesh.looseCount() > 0 ? BT_FEM_UNUSED_NODES : 0);
}

// What the body overlaps gets new collision algorithms at the next collision detection.
void renewAlgorithms(btSoftBody& body)
{
    btDispatcher* dispatcher = body.m_worldInfo->m_dispatcher;
    btBroadphaseInterface* broadphase = body.m_worldInfo->m_broadphase;
    if (dispatcher && broadphase && body.getBroadphaseHandle())
        broadphase->getOverlappingPairCache()->cleanProxyFromPairs(body.getBroadphaseHandle(), dispatcher);
}

// A body that was FEM until it was cut or refined has its mark and a FEM body's algorithms; with those, Bullet's
// springs would be given whole planes and meshes, which they take for nothing.
void leaveToBullet(btSoftBody& body)
{
    unmarkBody(body);
    giveFaceTreeToBullet(body);
    clearBulletContacts(body);
    if (body.m_worldInfo) renewAlgorithms(body);
}

}  // namespace

std::vector<double> massesAtRest(const btFemEntry& entry, double density)
{
    const btSoftBody& body = *entry.m_softBody;
    const bool known = entry.m_fem && !restMatricesChanged(*entry.m_fem);
    const TetMesh mesh = known ? entry.m_fem->m_body.m_model->mesh() : tetMeshOf(body);
    return massesOf(mesh, filledFractionsOf(body), density * massScaleOf(body));
}

std::size_t btFemBodyRegistry::indexOf(const btSoftBody* body) const
{
    const auto isIt = [body](const auto& entry) { return entry->m_softBody == body; };
    return std::find_if(m_entries.begin(), m_entries.end(), isIt) - m_entries.begin();
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
    if (btFemEntry* known = find(body))
    {
        lookAgain(*known);
        return *known;
    }
    m_entries.push_back(std::make_unique<btFemEntry>(body));
    return *m_entries.back();
}

void btFemBodyRegistry::forget(const btSoftBody* body)
{
    m_entries.erase(std::remove_if(m_entries.begin(), m_entries.end(),
                                   [body](const auto& entry) { return entry->m_softBody == body; }),
                    m_entries.end());
}

bool btFemBodyRegistry::isAsBuilt(const btFemEntry& entry)
{
    return !entry.m_fem || (hasMark(*entry.m_softBody, entry.m_fem->m_mark) && topologyAsSetUp(*entry.m_fem));
}

// Something else may live at the address, or nodes or tetrahedra were appended, removed, or joined otherwise: then the
// body keeps what the user asked for it.
void btFemBodyRegistry::lookAgain(btFemEntry& entry)
{
    if (!entry.m_fem) return;
    if (!hasMark(*entry.m_softBody, entry.m_fem->m_mark))
    {
        entry = btFemEntry(entry.m_softBody);
        return;
    }
    followNodes(*entry.m_fem);
    if (topologyAsSetUp(*entry.m_fem)) return;
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

void btFemBodyRegistry::synchronise(const btAlignedObjectArray<btSoftBody*>& softBodies, const btSoftBodySolver* solver)
{
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
        if (known < m_entries.size()) lookAgain(*m_entries[known]);
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
    m_entries.resize(kept);
}

bool btFemBodyRegistry::worldHolds(const btSoftBody& body, const btCollisionObject* object)
{
    m_worldObjects.read(body);
    return m_worldObjects.holds(object);
}

void btFemBodyRegistry::registerWithDispatcher(btSoftBody& body) const
{
    if (!body.m_worldInfo) return;
    btDispatcher* dispatcher = body.m_worldInfo->m_dispatcher;
    dispatchRigidShapes(dispatcher);
    if (m_showsManifolds) btFemManifolds::showIn(dispatcher);
    answerContactTests(dispatcher);
    renewAlgorithms(body);  // what it overlapped before it was FEM has Bullet's
}

void btFemBodyRegistry::setUp(btFemEntry& entry, double step)
{
    btSoftBody& soft = *entry.m_softBody;
    if (soft.m_tetras.size() == 0)
        throw std::invalid_argument(
            "the soft body has no tetrahedra; make it with btFemHelpers, or leave it to Bullet's springs");
    if (entry.m_fem)
        renew(entry, step);
    else
        setUpNew(entry, step);
    entry.m_materialChanged = false;
}

void btFemBodyRegistry::setUpNew(btFemEntry& entry, double step)
{
    btSoftBody& soft = *entry.m_softBody;
    const std::shared_ptr<const btFemDefinition> defined = entry.m_definition;
    const RestMesh rest = defined ? RestMesh{TetMesh(defined->m_restPositions, defined->m_tets, LooseNodes::kept),
                                             defined->m_restOrigin, true}
                                  : restMeshOf(soft);
    const TetMesh& mesh = rest.m_mesh;
    const std::vector<double> filled = filledFractionsOf(soft);
    const auto shape = m_library.restShape(mesh, materialOf(entry), filled);
    FactorInput input;
    bool repaired = false;
    input.m_mass = sanitisedMasses(soft, massesOf(mesh, filled, 1), repaired);
    if (repaired) writeMasses(soft, input.m_mass);
    for (int i = 0; i < soft.m_nodes.size(); ++i)
    {
        const bool pinned = soft.m_nodes[i].m_im == 0;
        input.m_fixed.push_back(pinned || mesh.isLoose(i));
        if (defined && pinned) input.m_mass[i] = defined->m_mass[i];
    }
    input.m_step = step;
    const auto model = m_library.model(shape, input);
    entry.m_fem =
        std::make_unique<FemSoftBody>(soft, model, m_library.compliance(model), m_library.restNeighbours(shape));
    entry.m_fem->m_body.m_state.m_mass = input.m_mass;  // the model's may be those of a copy elsewhere
    entry.m_fem->m_restOrigin = rest.m_origin;
    entry.m_definition.reset();
    makeFaces(soft, mesh);
    registerWithDispatcher(soft);
    keepFaceTree(soft);
    entry.m_fem->m_contactOffset = entry.m_contactOffset;
    entry.m_setUpFlags = flagsOf(mesh) | (repaired ? BT_FEM_BAD_MASS : 0);
    if (entry.m_wasChanged) entry.m_report.m_flags |= BT_FEM_CHANGED_MESH;
    entry.m_wasChanged = false;
}

void btFemBodyRegistry::renew(btFemEntry& entry, double step)
{
    FemSoftBody& fem = *entry.m_fem;
    // The factor is for the masses and pins of now; a new density has just changed the masses.
    const NodeReadReport read = readNodes(fem);
    entry.m_report.m_flags |= (read.m_restored ? BT_FEM_RESTORED : 0) | (read.m_badMass ? BT_FEM_BAD_MASS : 0);
    RestMesh rest;
    if (restMatricesChanged(fem))
    {
        noteRestMatrices(fem);  // tried once, whatever comes of it
        rest = restMeshOf(*fem.m_softBody);
    }
    const TetMesh& mesh = rest.m_known ? rest.m_mesh : fem.m_body.m_model->mesh();
    const auto shape = m_library.restShape(mesh, materialOf(entry), filledFractionsOf(*fem.m_softBody));
    const auto model = m_library.model(shape, factorInput(entry, step));
    if (rest.m_known)
    {
        changeRestShape(fem, model, m_library.compliance(model), m_library.restNeighbours(shape));
        fem.m_restOrigin = rest.m_origin;
        entry.m_setUpFlags = flagsOf(mesh);
        entry.m_formerModel.reset();
        entry.m_formerCompliance.reset();
    }
    else
    {
        fem.m_body.setModel(model);
        fem.m_compliance = m_library.compliance(model);
    }
    entry.m_factorAccount = {};
    entry.m_factorJob.reset();
}

void btFemBodyRegistry::trySetUp(btFemEntry& entry, double step)
{
    try
    {
        setUp(entry, step);
        entry.m_message.clear();
    }
    catch (const std::exception& error)
    {
        entry.m_message = error.what();
        if (!entry.m_fem) reject(entry);  // a body that moved already keeps its old material and rest shape
        entry.m_materialChanged = false;
    }
}

void btFemBodyRegistry::reject(btFemEntry& entry)
{
    entry.m_rejected = true;
    leaveToBullet(*entry.m_softBody);
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
    entry.m_formerCompliance = former ? m_library.compliance(former) : nullptr;
}

void btFemBodyRegistry::putFirst(const std::vector<btFemEntry*>& entries)
{
    const auto place = [&entries](const std::unique_ptr<btFemEntry>& entry)
    { return std::find(entries.begin(), entries.end(), entry.get()); };
    std::stable_sort(m_entries.begin(), m_entries.end(),
                     [&place](const auto& a, const auto& b) { return place(a) < place(b); });
}

void btFemBodyRegistry::exchangeModel(btFemEntry& entry, const std::shared_ptr<const BodyModel>& model)
{
    FemSoftBody& fem = *entry.m_fem;
    if (model == fem.m_body.m_model) return;
    entry.m_formerModel = fem.m_body.m_model;
    entry.m_formerCompliance = fem.m_compliance;
    fem.m_body.setModel(model);
    fem.m_compliance = m_library.compliance(model);
}
