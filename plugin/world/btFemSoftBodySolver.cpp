// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemSoftBodySolver.h"

#include <stdexcept>

#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/body_arrays.h"
#include "bullet_bridge/body/face_tree.h"
#include "bullet_bridge/body/node_exchange.h"
#include "bullet_bridge/body/soft_body_mesh.h"
#include "fem/common/attempt.h"
#include "fem/common/message.h"
#include "plugin/dispatch/btFemDispatch.h"
#include "plugin/dispatch/btFemManifolds.h"
#include "plugin/record/btFemCollisionFlags.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/setup/btFemBaked.h"
#include "plugin/setup/btFemBodyMaterials.h"
#include "plugin/snapshot/btFemSnapshot.h"
#include "plugin/stages/btFemCloth.h"
#include "plugin/stages/btFemSleeping.h"
#include "plugin/world/btFemWorldStep.h"

using namespace bullet_fem;

struct btFemSoftBodySolver::Impl
{
    explicit Impl(const btFemSolverInfo& info)
        : m_setUp(info, info.m_manifolds ? announceWithManifolds : announceToDispatcher),
          m_step(info, m_registry, m_setUp),
          m_manifolds(info.m_manifolds ? std::make_shared<btFemManifolds>() : nullptr)
    {
    }

    btFemBodyRecord& femRecord(const btSoftBody* body, const char* caller)
    {
        btFemBodyRecord* record = m_registry.find(body);
        if (!record || !record->isFem())
            throw std::invalid_argument(
                std::string(caller) +
                ": the body is not moved by finite elements; call prepare() or step its world first");
        if (!arraysAsSetUp(record->fem()))
            throw std::invalid_argument(
                std::string(caller) +
                ": nodes or tetrahedra of the body were appended or removed; call prepare() or step its world first");
        return *record;
    }

    void dropRemovedBodies(btAlignedObjectArray<btSoftBody*>& stepped)
    {
        if (m_worldBodies) m_registry.dropRemoved(*m_worldBodies, stepped);
    }

    bool movesBySprings(const btSoftBody* body) const
    {
        if (!body->isActive()) return false;
        const btFemBodyRecord* record = m_registry.find(body);
        return !record || (record->m_model.m_rejected && record->m_membership.m_present);
    }

    ClothContacts& cloth() { return m_step.group().cloth(); }

    // Call before the search for contact with cloth.
    void moveCloth(const btAlignedObjectArray<btSoftBody*>& bodies)
    {
        if (m_clothBodies) listCloth(m_registry, *m_clothBodies, cloth());
        for (int i = 0; i < bodies.size() && cloth().hasPairs(); ++i)
            if (movesBySprings(bodies[i])) cloth().solveSprings(*bodies[i]);
    }

    // Soft bodies of the world being stepped, including cloth.
    const btAlignedObjectArray<btSoftBody*>*m_worldBodies = nullptr, *m_clothBodies = nullptr;
    btFemBodyRegistry m_registry;
    btFemBodySetUp m_setUp;
    btFemWorldStep m_step;
    const std::shared_ptr<btFemManifolds> m_manifolds;  // null: not shown
    const btFemStepReport m_noReport;
    const btAlignedObjectArray<btFemContact> m_noContacts;
    const btAlignedObjectArray<btFemTouch> m_noTouches;
    const btAlignedObjectArray<btFemAnchorReport> m_noAnchors;
    btFemStressScratch m_stressScratch;
};

btFemSoftBodySolver::btFemSoftBodySolver(const btFemSolverInfo& info)
{
    std::string why;
    if (!info.valid(&why)) throw std::invalid_argument("btFemSolverInfo: " + why);
    m_impl = std::make_unique<Impl>(info);
}

btFemSoftBodySolver::~btFemSoftBodySolver() = default;

bool btFemSoftBodySolver::setMaterial(btSoftBody* body, const btFemMaterial& material, std::string* why)
{
    return attempt(why, [&] { giveMaterials(m_impl->m_registry, body, materialOfAll(material)); });
}

bool btFemSoftBodySolver::setMaterials(btSoftBody* body, const std::vector<btFemMaterial>& perTetrahedron,
                                       std::string* why)
{
    return attempt(why, [&] { giveMaterials(m_impl->m_registry, body, materialsOfTets(perTetrahedron)); });
}

bool btFemSoftBodySolver::setMaterials(btSoftBody* body, const std::vector<int>& labels,
                                       const std::map<int, btFemMaterial>& ofLabel, std::string* why)
{
    return attempt(why, [&] { giveMaterials(m_impl->m_registry, body, materialsOfRegions(labels, ofLabel)); });
}

bool btFemSoftBodySolver::setMaterials(btSoftBody* body,
                                       const std::function<btFemMaterial(const btVector3& centroid)>& materialAt,
                                       std::string* why)
{
    return attempt(why, [&] { giveMaterials(m_impl->m_registry, body, materialsByPlace(materialAt)); });
}

bool btFemSoftBodySolver::setDetail(btSoftBody* body, btFemDetail detail, std::string* why)
{
    const auto set = [&]
    {
        if (detail < btFemDetail::nodalWarp || detail > btFemDetail::automatic)
            bullet_fem::reject("setDetail: the detail is ", static_cast<int>(detail),
                               "; it must be one of btFemDetail, 0 to ", static_cast<int>(btFemDetail::automatic));
        btFemBodyRecord& record = m_impl->m_registry.record(body);
        record.m_asked.m_detail = detail;
        record.m_work.m_detailLevel = {};
    };
    return attempt(why, set);
}

bool btFemSoftBodySolver::setInterest(btFemInterest* interest, const btFemDetailPolicy& policy, std::string* why)
{
    return attempt(why, [&] { m_impl->m_step.setInterest(interest, policy); });
}

bool btFemSoftBodySolver::prepare(btSoftBody* body, btScalar fixedTimeStep, std::string* why)
{
    const auto setUp = [&]
    {
        btFemBodyRecord& record = m_impl->m_registry.record(body);
        m_impl->m_setUp.setUp(record, fixedTimeStep);
        record.m_model.m_rejected = false;
        m_impl->m_setUp.chooseSurface(record);
    };
    return attempt(why, setUp);
}

bool btFemSoftBodySolver::useBaked(btSoftBody* body, const BakedBody& baked, std::string* why)
{
    return attempt(why, [&] { ::useBaked(m_impl->m_registry, body, baked); });
}

bool btFemSoftBodySolver::refactor(btSoftBody* body, std::string* why)
{
    const auto renew = [&]
    {
        btFemBodyRecord& record = m_impl->femRecord(body, "refactor");
        readNodes(record.fem());
        const double last = record.m_work.m_lastStep;
        m_impl->m_setUp.refactor(record, last > 0 ? last : record.fem().m_body.m_model->factorInput().m_step);
        record.m_work.m_factorAccount.clear();
        record.m_work.m_factorJob.reset();
    };
    return attempt(why, renew);
}

bool btFemSoftBodySolver::setContactOffset(btSoftBody* body, btScalar metres, std::string* why)
{
    const auto set = [&]
    {
        if (!(metres >= 0 && metres <= 1000))
            throw std::invalid_argument("contact offset " + std::to_string(metres) + " m is not in [0, 1000]");
        btFemBodyRecord& record = m_impl->m_registry.record(body);
        record.m_asked.m_contactOffset = metres;
        if (!record.isFem()) return;
        record.fem().m_settings.m_contactOffset = metres;
        record.fem().m_memory.m_place.forget();  // what it touches is searched for again
    };
    return attempt(why, set);
}

void btFemSoftBodySolver::forget(btSoftBody* body)
{
    m_impl->m_registry.forget(body);
}

bool btFemSoftBodySolver::valid(const btSoftBody* body, std::string* why)
{
    std::string reason;
    return canBecomeFem(body, why ? *why : reason);
}

bool btFemSoftBodySolver::isFem(const btSoftBody* body) const
{
    const btFemBodyRecord* record = m_impl->m_registry.find(body);
    return record && record->isFem();
}

const btFemStepReport& btFemSoftBodySolver::stepReport(const btSoftBody* body) const
{
    const btFemBodyRecord* record = m_impl->m_registry.find(body);
    return record ? record->m_reports.m_step : m_impl->m_noReport;
}

const btAlignedObjectArray<btFemContact>& btFemSoftBodySolver::contacts(const btSoftBody* body) const
{
    const btFemBodyRecord* record = m_impl->m_registry.find(body);
    return record ? record->m_reports.m_contacts : m_impl->m_noContacts;
}

const btAlignedObjectArray<btFemAnchorReport>& btFemSoftBodySolver::anchors(const btSoftBody* body) const
{
    const btFemBodyRecord* record = m_impl->m_registry.find(body);
    return record ? record->m_reports.m_anchors : m_impl->m_noAnchors;
}

const btAlignedObjectArray<btFemTouch>& btFemSoftBodySolver::touches(const btSoftBody* body) const
{
    const btFemBodyRecord* record = m_impl->m_registry.find(body);
    return record ? record->m_reports.m_touches : m_impl->m_noTouches;
}

btVector3 btFemSoftBodySolver::contactForce(const btSoftBody* body, const btCollisionObject* other) const
{
    const btFemBodyRecord* record = m_impl->m_registry.find(body);
    btVector3 sum(0, 0, 0);
    if (!record || !(record->m_work.m_lastStep > 0)) return sum;
    for (int k = 0; k < record->m_reports.m_contacts.size(); ++k)
        if (record->m_reports.m_contacts[k].m_other == other) sum += record->m_reports.m_contacts[k].m_impulse;
    return sum / static_cast<btScalar>(record->m_work.m_lastStep);
}

bool btFemSoftBodySolver::getContactForces(const btSoftBody* body, btAlignedObjectArray<btVector3>& perNode) const
{
    const btFemBodyRecord* record = m_impl->m_registry.find(body);
    const bool known = record && record->isFem() && arraysAsSetUp(record->fem());
    perNode.resize(known ? body->m_nodes.size() : 0);
    for (int i = 0; i < perNode.size(); ++i) perNode[i].setZero();
    for (int k = 0; known && record->m_work.m_lastStep > 0 && k < record->m_reports.m_contacts.size(); ++k)
    {
        const btFemContact& contact = record->m_reports.m_contacts[k];
        for (int a = 0; a < contact.m_nodeCount; ++a)
            if (contact.m_nodes[a] < perNode.size())  // prepare() may have found fewer nodes than the last step
                perNode[contact.m_nodes[a]] +=
                    contact.m_impulse * (contact.m_weights[a] / static_cast<btScalar>(record->m_work.m_lastStep));
    }
    return known;
}

btFemContactGroup* btFemCoupling::beginGroup(btFemSoftBodySolver& fem, const btFemIsland& island, double step,
                                             bool linksToo)
{
    fem.m_impl->moveCloth(fem.m_softBodySet);
    return fem.m_impl->m_step.beginGroup(island, step, linksToo);
}

void btFemCoupling::setClothBodies(btFemSoftBodySolver& fem, const btAlignedObjectArray<btSoftBody*>& bodies)
{
    fem.m_impl->m_clothBodies = &bodies;
}

btFemBodyRecord& btFemCoupling::femRecord(btFemSoftBodySolver& fem, const btSoftBody* body, const char* caller)
{
    return fem.m_impl->femRecord(body, caller);
}

const btFemBodyRecord* btFemCoupling::record(const btFemSoftBodySolver& fem, const btSoftBody& body)
{
    return fem.m_impl->m_registry.find(&body);
}

btFemWeldBreaker& btFemCoupling::welds(const btFemSoftBodySolver& fem)
{
    return fem.m_impl->m_step.group().welds();
}

btFemSplitter& btFemCoupling::splitter(const btFemSoftBodySolver& fem)
{
    return fem.m_impl->m_step.splitter();
}

btFemBodyRegistry& btFemCoupling::registry(const btFemSoftBodySolver& fem)
{
    return fem.m_impl->m_registry;
}

void btFemCoupling::assumeForcesGiven(btFemSoftBodySolver& fem, const Vec3& gravity)
{
    fem.m_impl->m_step.assumeForcesGiven(gravity);
}

std::shared_ptr<btFemManifolds> btFemCoupling::manifolds(const btFemSoftBodySolver& fem)
{
    return fem.m_impl->m_manifolds;
}

btFemStressScratch& btFemCoupling::stressScratch(const btFemSoftBodySolver& fem)
{
    return fem.m_impl->m_stressScratch;
}

btFemSnapshotScope btFemCoupling::snapshotScope(const btFemSoftBodySolver& fem)
{
    return {fem.m_impl->m_registry, fem.m_impl->m_setUp, fem.m_impl->m_step.group(), fem.m_impl->m_step.splitter(),
            fem.m_impl->m_worldBodies};
}

void btFemSoftBodySolver::optimize(btAlignedObjectArray<btSoftBody*>& softBodies, bool forceUpdate)
{
    btDefaultSoftBodySolver::optimize(softBodies, forceUpdate);
    m_impl->m_worldBodies = m_impl->m_clothBodies = &softBodies;
    m_impl->m_registry.synchronise(softBodies, this, m_impl->m_step.threads());
}

bool btFemSoftBodySolver::checkInitialized()
{
    if (m_impl->m_worldBodies) m_impl->m_step.noteWorld(*m_impl->m_worldBodies);
    return true;
}

void btFemSoftBodySolver::predictMotion(btScalar timeStep)
{
    m_impl->dropRemovedBodies(m_softBodySet);
    m_impl->m_step.predict(timeStep);
    for (int i = 0; i < m_softBodySet.size(); ++i)
    {
        if (!m_impl->movesBySprings(m_softBodySet[i])) continue;
        if (m_impl->m_registry.find(m_softBodySet[i])) updateWithoutTree(*m_softBodySet[i]);
        m_softBodySet[i]->predictMotion(timeStep);
    }
}

void btFemSoftBodySolver::processCollision(btSoftBody* body, const btCollisionObjectWrapper* other)
{
    const btFemBodyRecord* record = m_impl->m_registry.find(body);
    if (!record || record->m_model.m_rejected)
    {
        if (hasUsableNodes(*body)) btDefaultSoftBodySolver::processCollision(body, other);
    }
    else if (record->m_membership.m_present && record->isFem() && !ignoresRigidBodies(*body) &&
             other->getCollisionObject()->hasContactResponse() &&
             !ignoresCollision(*body, *other->getCollisionObject()))
    {
        wakeIfPushed(*record, *other->getCollisionObject());
        recordOverlap(record->fem(), *other->getCollisionObject());
        m_impl->m_step.noteBeforeSolve(*other->getCollisionObject());
    }
}

void btFemSoftBodySolver::processCollision(btSoftBody* body, btSoftBody* other)
{
    const btFemBodyRecord* record = m_impl->m_registry.find(body);
    const bool fem = record && record->isFem(), otherFem = isFem(other);
    if (!fem && !otherFem)  // Bullet's handlers would move nodes of FEM bodies
    {
        if (hasUsableNodes(*body) && hasUsableNodes(*other)) btDefaultSoftBodySolver::processCollision(body, other);
        return;
    }
    if (!collide(*body, *other)) return;
    if (fem && otherFem) return recordOverlap(record->fem(), *other);
    btSoftBody& cloth = fem ? *other : *body;
    if (isCloth(cloth)) m_impl->cloth().note(m_impl->m_registry.find(fem ? body : other)->fem(), cloth);
}

void btFemSoftBodySolver::solveConstraints(btScalar timeStep)
{
    m_impl->dropRemovedBodies(m_softBodySet);
    m_impl->moveCloth(m_softBodySet);
    m_impl->m_step.solve(timeStep);
    for (int i = 0; i < m_softBodySet.size(); ++i)
        if (m_impl->movesBySprings(m_softBodySet[i])) m_impl->cloth().finishSprings(*m_softBodySet[i]);
}

void btFemSoftBodySolver::updateSoftBodies()
{
    m_impl->dropRemovedBodies(m_softBodySet);
    for (int i = 0; i < m_softBodySet.size(); ++i)
    {
        if (!m_softBodySet[i]->isActive()) continue;
        const btFemBodyRecord* record = m_impl->m_registry.find(m_softBodySet[i]);
        if (!(record && record->isStepped())) m_softBodySet[i]->integrateMotion();
    }
    m_impl->m_step.publish();
    if (m_impl->m_manifolds) m_impl->m_manifolds->update();
    m_impl->m_step.split();
}
