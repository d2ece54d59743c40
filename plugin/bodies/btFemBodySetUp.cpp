// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// How a body becomes FEM, and gets another material or rest shape.
#include <memory>
#include <stdexcept>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body_mark.h"
#include "bullet_bridge/collision_skin.h"
#include "bullet_bridge/face_tree.h"
#include "bullet_bridge/node_exchange.h"
#include "bullet_bridge/shapes/rigid_dispatch.h"
#include "bullet_bridge/soft_body_mesh.h"
#include "bullet_fem/btFemCollision.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/bodies/btFemBaked.h"
#include "plugin/bodies/btFemBodyRegistry.h"
#include "plugin/bodies/btFemDefinition.h"
#include "plugin/contact/btFemContactTest.h"
#include "plugin/contact/btFemManifolds.h"

using namespace bullet_fem;

namespace
{

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

RestMesh restOf(const btFemEntry& entry)
{
    const auto& defined = entry.m_definition;
    if (!defined) return restMeshOf(*entry.m_softBody);
    return {TetMesh(defined->m_restPositions, defined->m_tets, LooseNodes::kept), defined->m_restOrigin, true};
}

}  // namespace

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
    readyForSelfContact(entry);
    entry.m_materialChanged = false;
}

// True if it was baked, is still what was baked, and its factor is not too large for this solver.
bool btFemBodyRegistry::canUseBaked(const btFemEntry& entry) const
{
    return entry.m_baked && isAsBaked(*entry.m_softBody, *entry.m_baked) &&
           m_library.allows(entry.m_baked->m_model->factorReport().m_bytes);
}

// The baked mesh, of the material that the body is to have.
std::shared_ptr<const RestShape> btFemBodyRegistry::bakedShape(const btFemEntry& entry,
                                                               const std::vector<double>& filled)
{
    const std::shared_ptr<const RestShape>& shape = entry.m_baked->m_model->sharedShape();
    const Material material = materialOf(entry);
    return shape->m_material == material ? m_library.adoptShape(shape, filled)
                                         : m_library.restShape(shape->m_mesh, material, filled);
}

void btFemBodyRegistry::setUpNew(btFemEntry& entry, double step)
{
    btSoftBody& soft = *entry.m_softBody;
    const std::shared_ptr<const btFemDefinition> defined = entry.m_definition;
    const bool baked = canUseBaked(entry);
    const std::vector<double> filled = filledFractionsOf(soft);
    const RestMesh rest = baked ? RestMesh{TetMesh(), vec3(soft.m_nodes[0].m_x), true} : restOf(entry);
    const auto shape = baked ? bakedShape(entry, filled) : m_library.restShape(rest.m_mesh, materialOf(entry), filled);
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
    input.m_step = step;
    const auto model =
        baked ? m_library.modelWithFactor(shape, input, entry.m_baked->m_model) : m_library.model(shape, input);
    entry.m_fem = std::make_unique<FemSoftBody>(soft, model, m_library.compliance(model));
    entry.m_fem->m_body.m_state.m_mass = input.m_mass;    // the model's may be those of a copy elsewhere,
    entry.m_fem->m_body.m_state.m_fixed = input.m_fixed;  // or of when it was baked
    entry.m_fem->m_restOrigin = rest.m_origin;
    entry.m_definition.reset();
    makeFaces(soft, mesh);
    registerWithDispatcher(soft);
    keepFaceTree(soft);
    entry.m_fem->m_contactOffset = entry.m_contactOffset;
    entry.m_setUpFlags =
        flagsOf(mesh) | (repaired ? BT_FEM_BAD_MASS : 0) | (entry.m_baked && !baked ? BT_FEM_BAKED_UNUSED : 0);
    entry.m_baked.reset();
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
        changeRestShape(fem, model, m_library.compliance(model));
        entry.m_hasAskedSurface = false;
        fem.m_restOrigin = rest.m_origin;
        entry.m_setUpFlags = flagsOf(mesh);
        entry.m_formerModel.reset();
        entry.m_formerCompliance.reset();
    }
    else
    {
        fem.m_body.setModel(model);
        fem.m_compliance = m_library.compliance(model, fem.m_skin.get());
    }
    entry.m_factorAccount = {};
    entry.m_factorJob.reset();
}

bool btFemBodyRegistry::readyForSelfContact(btFemEntry& entry)
{
    if (!(entry.m_softBody->m_cfg.collisions & btSoftBody::fCollision::CL_SELF)) return false;
    FemSoftBody& fem = *entry.m_fem;
    if (!fem.m_surface.hasRestNeighbours())
        fem.m_surface.setRestNeighbours(m_library.restNeighbours(fem.m_body.m_model->sharedShape(), fem.m_skin.get()));
    return true;
}

void btFemBodyRegistry::chooseSurface(btFemEntry& entry)
{
    FemSoftBody& fem = *entry.m_fem;
    const bool wanted = (fem.m_softBody->m_cfg.collisions & BT_FEM_RENDER_SURFACE) != 0;
    if (entry.m_hasAskedSurface && wanted == entry.m_asksSkin) return;
    entry.m_asksSkin = wanted;
    entry.m_hasAskedSurface = true;
    entry.m_setUpFlags &= ~BT_FEM_BAD_SURFACE;
    const std::shared_ptr<const BodyModel> model = fem.m_body.m_model;
    const auto take = [&](const std::shared_ptr<const CollisionSkin>& skin)
    {
        fem.setSkin(skin, m_library.compliance(model, skin.get()));
        readyForSelfContact(entry);
        entry.m_formerModel.reset();  // its compliance is for other nodes
        entry.m_formerCompliance.reset();
    };
    try
    {
        if (wanted || fem.m_skin) take(wanted ? skinOf(*fem.m_softBody, model->mesh()) : nullptr);
    }
    catch (const std::exception&)
    {
        entry.m_setUpFlags |= BT_FEM_BAD_SURFACE;
        take(nullptr);
        throw;
    }
}

void btFemBodyRegistry::tryChooseSurface(btFemEntry& entry)
{
    try
    {
        chooseSurface(entry);
    }
    catch (const std::exception& error)
    {
        entry.m_message = error.what();
    }
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
