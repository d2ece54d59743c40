// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// btFemBodySetUp: makes bodies FEM, and changes their material or rest shape.
#include "plugin/setup/btFemBodySetUp.h"

#include <memory>
#include <stdexcept>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/body_mark.h"
#include "bullet_bridge/body/collision_skin.h"
#include "bullet_bridge/body/face_tree.h"
#include "bullet_bridge/body/node_exchange.h"
#include "bullet_bridge/body/rest_positions.h"
#include "bullet_bridge/body/rigid_dispatch.h"
#include "bullet_bridge/body/soft_body_mesh.h"
#include "bullet_bridge/body/split_soft_body.h"
#include "bullet_fem/btFemCollision.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/body/active_stress.h"
#include "fem/common/attempt.h"
#include "fem/common/reason.h"
#include "plugin/setup/btFemBaked.h"

using namespace bullet_fem;

namespace
{

constexpr int kTouches = 8;  // objects that a body touches before the list of touches grows

FactorChoice coreChoice(btFemFactorChoice choice)
{
    if (choice == btFemFactorChoice::lowMemoryBeyond) return FactorChoice::lowMemoryBeyond;
    return choice == btFemFactorChoice::lowMemory ? FactorChoice::lowMemory : FactorChoice::full;
}

int flagsOf(const TetMesh& mesh)
{
    return (mesh.turnedCount() > 0 ? BT_FEM_TURNED_TETS : 0) |
           (mesh.componentCount() - mesh.looseCount() > 1 ? BT_FEM_SEVERAL_PIECES : 0) |
           (mesh.looseCount() > 0 ? BT_FEM_UNUSED_NODES : 0) | (mesh.sliverCount() > 0 ? BT_FEM_SLIVERS : 0);
}

// Returns a body to Bullet. A former FEM body has a mark and FEM collision algorithms, which would give Bullet's
// springs whole planes and meshes that they cannot handle.
void leaveToBullet(btSoftBody& body)
{
    unmarkBody(body);
    giveFaceTreeToBullet(body);
    clearBulletContacts(body);
    if (body.m_worldInfo) renewAlgorithms(body);
}

RestMesh restOf(const btFemBodyRecord& record)
{
    const auto& defined = record.m_asked.m_definition;
    if (!defined) return restMeshOf(*record.m_softBody);
    return {TetMesh(defined->m_restPositions, defined->m_tets, LooseNodes::kept), defined->m_restOrigin, true};
}

}  // namespace

btFemBodySetUp::btFemBodySetUp(const btFemSolverInfo& info, void (*announce)(btSoftBody& body))
    : m_announce(announce),
      m_numericalDamping(std::max(info.m_numericalDamping, info.m_contactDamping)),
      m_library(static_cast<std::size_t>(1e6 * info.m_maxFactorMegabytes), coreChoice(info.m_factorChoice))
{
}

bool canBecomeFem(const btSoftBody* body, std::string& why)
{
    if (!body)
        why = "the soft body is null; give one made by btFemHelpers or btSoftBodyHelpers";
    else if (body->m_tetras.size() == 0)
        why = "the soft body has no tetrahedra; make it with btFemHelpers";
    else
        return attempt(&why, [body] { tetMeshOf(*body); });
    return false;
}

RestMesh restMeshNow(const btFemBodyRecord& record)
{
    if (!record.isFem() || restMatricesChanged(record.fem())) return restMeshOf(*record.m_softBody);
    return {record.fem().m_body.m_model->mesh(), record.fem().m_setUp.m_restOrigin, true};
}

std::vector<double> massesAtRest(const TetMesh& rest, const btSoftBody& body, const ElementMaterials& materials)
{
    return lumpedMasses(rest, filledFractionsOf(body), materials, massScaleOf(body));
}

void btFemBodySetUp::setUp(btFemBodyRecord& record, double step)
{
    btSoftBody& soft = *record.m_softBody;
    if (soft.m_tetras.size() == 0)
        throw std::invalid_argument(
            "the soft body has no tetrahedra; make it with btFemHelpers, or leave it to Bullet's springs");
    if (record.isFem())
        renew(record, step);
    else
        setUpNew(record, step);
    if (record.fem().m_body.m_actuators.hasActiveStress()) applyActiveStress(record.fem().m_body);
    readyForSelfContact(record);
    record.m_asked.m_materialChanged = false;
}

// True if the body is still as baked, and the baked factor is within the memory limit.
bool btFemBodySetUp::canUseBaked(const btFemBodyRecord& record) const
{
    return record.m_asked.m_baked && isAsBaked(*record.m_softBody, *record.m_asked.m_baked) &&
           m_library.allows(record.m_asked.m_baked->m_model->factorReport().m_bytes);
}

// The baked shape with the body's present materials.
std::shared_ptr<const RestShape> btFemBodySetUp::bakedShape(const btFemBodyRecord& record,
                                                            const std::vector<double>& filled)
{
    const std::shared_ptr<const RestShape>& shape = record.m_asked.m_baked->m_model->sharedShape();
    const ElementMaterials materials = materialsOf(record);
    return shape->m_materials == materials ? m_library.adoptShape(shape, filled)
                                           : m_library.restShape(shape->m_mesh, materials, filled);
}

void btFemBodySetUp::setUpNew(btFemBodyRecord& record, double step)
{
    btSoftBody& soft = *record.m_softBody;
    std::shared_ptr<const btFemDefinition>& defined = record.m_asked.m_definition;
    if (defined && !hasElements(soft, defined->m_restPositions.size(), defined->m_tets))  // it was cut meanwhile
    {
        defined.reset();
        record.m_model.m_wasChanged = true;
    }
    const bool baked = canUseBaked(record);
    const std::vector<double> filled = filledFractionsOf(soft);
    const RestMesh rest = baked ? RestMesh{TetMesh(), vec3(soft.m_nodes[0].m_x), true} : restOf(record);
    const auto shape =
        baked ? bakedShape(record, filled) : m_library.restShape(rest.m_mesh, materialsOf(record), filled);
    const TetMesh& mesh = baked ? shape->m_mesh : rest.m_mesh;
    FactorInput input;
    bool repaired = false;
    input.m_mass = sanitisedMasses(soft, lumpedMasses(mesh, filled, 1), repaired);
    if (repaired) writeMasses(soft, input.m_mass);
    for (int i = 0; i < soft.m_nodes.size(); ++i)
    {
        const bool pinned = soft.m_nodes[i].m_im == 0;
        input.m_fixed.push_back(pinned || mesh.isLoose(i));
        if (defined && pinned) input.m_mass[i] = defined->m_mass[i];
    }
    input.m_step = stepOfFactor(step, shape->m_material);
    const auto model = baked ? m_library.modelWithFactor(shape, input, record.m_asked.m_baked->m_model)
                             : m_library.model(shape, input);
    record.m_model.m_fem = std::make_unique<FemSoftBody>(soft, model, m_library.compliance(model));
    record.fem().m_settings.m_numericalDamping = m_numericalDamping;
    record.fem().m_body.m_state.m_mass = input.m_mass;    // the model's may be those of a copy elsewhere,
    record.fem().m_body.m_state.m_fixed = input.m_fixed;  // or of the baking
    record.fem().m_setUp.m_restOrigin = rest.m_origin;
    readLedPins(record.fem());
    record.m_asked.m_definition.reset();
    makeFaces(soft, mesh);
    m_announce(soft);
    keepFaceTree(soft);
    record.fem().m_settings.m_contactOffset = record.m_asked.m_contactOffset;
    record.m_model.m_flags =
        flagsOf(mesh) | (repaired ? BT_FEM_BAD_MASS : 0) | (record.m_asked.m_baked && !baked ? BT_FEM_BAKED_UNUSED : 0);
    record.m_asked.m_baked.reset();
    record.m_reports.m_touches.reserve(kTouches);
    if (record.m_model.m_wasChanged) record.m_reports.m_step.m_flags |= BT_FEM_CHANGED_MESH;
    record.m_model.m_wasChanged = false;
}

void btFemBodySetUp::renew(btFemBodyRecord& record, double step)
{
    FemSoftBody& fem = record.fem();
    // The factor needs the present masses and pins; a new density has just changed the masses.
    const NodeReadReport read = readNodes(fem);
    record.m_reports.m_step.m_flags |= (read.m_restored ? BT_FEM_RESTORED : 0) | (read.m_badMass ? BT_FEM_BAD_MASS : 0);
    RestMesh rest;
    if (restMatricesChanged(fem))
    {
        noteRestMatrices(fem);  // tried once, whether or not it succeeds
        rest = restMeshOf(*fem.m_softBody);
    }
    const TetMesh& mesh = rest.m_known ? rest.m_mesh : fem.m_body.m_model->mesh();
    const auto shape = m_library.restShape(mesh, materialsOf(record), filledFractionsOf(*fem.m_softBody));
    const auto model = m_library.model(shape, factorInput(record, step));
    if (rest.m_known)
    {
        changeRestShape(fem, model, m_library.compliance(model));
        record.m_model.m_hasAskedSurface = false;
        fem.m_setUp.m_restOrigin = rest.m_origin;
        record.m_model.m_flags = flagsOf(mesh);
        record.m_model.m_formerModel.reset();
        record.m_model.m_formerCompliance.reset();
    }
    else
    {
        fem.m_body.setModel(model);
        fem.m_compliance = m_library.compliance(model, fem.m_skin.get());
    }
    record.m_work.m_factorAccount = {};
    record.m_work.m_factorJob.reset();
}

bool btFemBodySetUp::readyForSelfContact(btFemBodyRecord& record)
{
    if (!(record.m_softBody->m_cfg.collisions & btSoftBody::fCollision::CL_SELF)) return false;
    FemSoftBody& fem = record.fem();
    if (!fem.m_surface.hasRestNeighbours())
        fem.m_surface.setRestNeighbours(m_library.restNeighbours(fem.m_body.m_model->sharedShape(), fem.m_skin.get()));
    return true;
}

void btFemBodySetUp::split(btFemBodyRecord& record, const SplitMesh& split)
{
    FemSoftBody& fem = record.fem();
    const TetMesh& before = fem.m_body.m_model->mesh();
    std::vector<Vec3> X = before.restPositions();
    FactorInput input = fem.m_body.m_model->factorInput();
    input.m_fixed = fem.m_body.m_state.m_fixed;
    for (int node : split.m_copyOf)
    {
        X.push_back(before.restPositions()[node]);
        input.m_fixed.push_back(fem.m_body.m_state.m_fixed[node]);
    }
    const std::vector<double> filled = filledFractionsOf(*record.m_softBody);
    input.m_mass = splitMasses(before, split, filled, fem.m_body.m_state.m_mass);
    const TetMesh mesh(std::move(X), split.m_tets, LooseNodes::kept);
    const auto model = m_library.model(m_library.restShape(mesh, materialsOf(record), filled), input);
    splitSoftBody(fem, split, input.m_mass, model, m_library.compliance(model));
    record.m_model.m_flags |= flagsOf(mesh);
    record.m_model.m_hasAskedSurface = false;
    record.m_model.m_formerModel.reset();
    record.m_model.m_formerCompliance.reset();
    record.m_model.m_faceIndex = {};
    record.m_work.m_factorAccount = {};
    record.m_work.m_factorJob.reset();
    record.m_work.m_insideOut = {};
    readyForSelfContact(record);
}

void btFemBodySetUp::chooseSurface(btFemBodyRecord& record)
{
    FemSoftBody& fem = record.fem();
    const bool wanted = (fem.m_softBody->m_cfg.collisions & BT_FEM_RENDER_SURFACE) != 0;
    if (record.m_model.m_hasAskedSurface && wanted == record.m_model.m_asksSkin) return;
    record.m_model.m_asksSkin = wanted;
    record.m_model.m_hasAskedSurface = true;
    record.m_model.m_flags &= ~BT_FEM_BAD_SURFACE;
    const std::shared_ptr<const BodyModel> model = fem.m_body.m_model;
    const auto take = [&](const std::shared_ptr<const CollisionSkin>& skin)
    {
        fem.setSkin(skin, m_library.compliance(model, skin.get()));
        readyForSelfContact(record);
        record.m_model.m_formerModel.reset();  // their compliance is for other nodes
        record.m_model.m_formerCompliance.reset();
    };
    try
    {
        if (wanted || fem.m_skin) take(wanted ? skinOf(*fem.m_softBody, model->mesh()) : nullptr);
    }
    catch (const std::exception&)
    {
        record.m_model.m_flags |= BT_FEM_BAD_SURFACE;
        take(nullptr);
        throw;
    }
}

void btFemBodySetUp::tryChooseSurface(btFemBodyRecord& record)
{
    try
    {
        chooseSurface(record);
    }
    catch (const std::exception& error)
    {
        record.m_model.m_message = reasonOf(error);
    }
}

void btFemBodySetUp::trySetUp(btFemBodyRecord& record, double step)
{
    try
    {
        setUp(record, step);
        record.m_model.m_message.clear();
    }
    catch (const std::exception& error)
    {
        record.m_model.m_message = reasonOf(error);
        if (!record.isFem()) reject(record);  // a FEM body keeps its former material and rest shape
        record.m_asked.m_materialChanged = false;
    }
}

void btFemBodySetUp::reject(btFemBodyRecord& record)
{
    record.m_model.m_rejected = true;
    leaveToBullet(*record.m_softBody);
}
