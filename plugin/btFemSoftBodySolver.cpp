// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemSoftBodySolver.h"

#include <stdexcept>

#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body_arrays.h"
#include "bullet_bridge/face_tree.h"
#include "bullet_bridge/joints/cluster_joints.h"
#include "bullet_bridge/joints/soft_joints.h"
#include "bullet_bridge/node_exchange.h"
#include "bullet_bridge/soft_body_mesh.h"
#include "bullet_fem/btFemHelpers.h"
#include "plugin/bodies/btFemBaked.h"
#include "plugin/bodies/btFemBodyRegistry.h"
#include "plugin/bodies/btFemMaterialConversion.h"
#include "plugin/btFemCoupling.h"
#include "plugin/btFemWorldStep.h"
#include "plugin/contact/btFemManifolds.h"

using namespace bullet_fem;

struct btFemSoftBodySolver::Impl
{
    explicit Impl(const btFemSolverInfo& info)
        : m_registry(info), m_step(info), m_manifolds(info.m_manifolds ? std::make_shared<btFemManifolds>() : nullptr)
    {
    }

    btFemEntry& femEntry(const btSoftBody* body, const char* caller)
    {
        btFemEntry* entry = m_registry.find(body);
        if (!entry || !entry->m_fem)
            throw std::invalid_argument(
                std::string(caller) +
                ": the body is not moved by finite elements; call prepare() or step its world first");
        if (!arraysAsSetUp(*entry->m_fem))
            throw std::invalid_argument(
                std::string(caller) +
                ": nodes or tetrahedra of the body were appended or removed; call prepare() or step its world first");
        return *entry;
    }

    // Tick callbacks run within a step, and may remove and delete soft bodies; Bullet tells nobody. Those whose arrays
    // they change stand still until the next step.
    void dropRemovedBodies(btAlignedObjectArray<btSoftBody*>& stepped)
    {
        if (!m_worldBodies) return;
        const auto isHeld = [this](btSoftBody* body)
        { return m_worldBodies->findLinearSearch(body) < m_worldBodies->size(); };
        int kept = 0;
        for (int i = 0; i < stepped.size(); ++i)
            if (isHeld(stepped[i])) stepped[kept++] = stepped[i];
        stepped.resize(kept);
        for (const auto& entry : m_registry.entries())
        {
            if (!entry->m_present) continue;
            const bool held = isHeld(entry->m_softBody),
                       changed = held && entry->m_fem && !arraysAsSetUp(*entry->m_fem);
            if (changed) showClusterJoints(*entry->m_fem);
            if (!held || changed) entry->m_present = false;
        }
    }

    bool movesBySprings(const btSoftBody* body) const
    {
        const btFemEntry* entry = m_registry.find(body);
        return body->isActive() && (!entry || (entry->m_rejected && entry->m_present));
    }

    const btAlignedObjectArray<btSoftBody*>* m_worldBodies = nullptr;  // of the world being stepped
    btFemBodyRegistry m_registry;
    btFemWorldStep m_step;
    const std::shared_ptr<btFemManifolds> m_manifolds;  // null: not shown
    const btFemStepReport m_noReport;
    const btAlignedObjectArray<btFemContact> m_noContacts;
    const btAlignedObjectArray<btFemTouch> m_noTouches;
    const btAlignedObjectArray<btFemAnchorReport> m_noAnchors;
    btFemStressScratch m_stressScratch;
};

namespace
{

// True if all rigid contact was switched off with m_cfg.collisions.
bool ignoresRigidBodies(const btSoftBody& body)
{
    using Flags = btSoftBody::fCollision;
    return (body.m_cfg.collisions & (Flags::RVSmask | Flags::RVDFmask)) == 0 || !body.hasContactResponse();
}

// Bodies collide with each other if both have a flag for it in common; a body with itself by CL_SELF.
bool collide(const btSoftBody& a, const btSoftBody& b)
{
    using Flags = btSoftBody::fCollision;
    const int mask = &a == &b ? static_cast<int>(Flags::CL_SELF) : Flags::SVSmask & ~Flags::CL_SELF;
    return (a.m_cfg.collisions & b.m_cfg.collisions & mask) != 0 && a.hasContactResponse() && b.hasContactResponse() &&
           !ignoresCollision(a, b) && !ignoresCollision(b, a);
}

// Bullet builds its tree of nodes along the links, and never ends without any: helpers' bodies have none.
void updateWithoutTree(btSoftBody& body)
{
    if (!body.m_bUpdateRtCst || body.m_links.size() > 0) return;
    body.m_bUpdateRtCst = false;
    body.updateLinkConstants();
    body.updateArea();
    giveFaceTreeToBullet(body);
}

}  // namespace

btFemSoftBodySolver::btFemSoftBodySolver(const btFemSolverInfo& info)
{
    std::string why;
    if (!info.valid(&why)) throw std::invalid_argument("btFemSolverInfo: " + why);
    m_impl = std::make_unique<Impl>(info);
}

btFemSoftBodySolver::~btFemSoftBodySolver() = default;

void btFemSoftBodySolver::setMaterial(btSoftBody* body, const btFemMaterial& material)
{
    std::string why;
    if (!material.valid(&why)) throw std::invalid_argument("btFemMaterial: " + why);
    if (m_impl->m_registry.find(body)) m_impl->m_registry.entry(body);  // which notices what the program changed
    if (!valid(body, &why)) throw std::invalid_argument("setMaterial: " + why);
    keepFaceTree(*body);
    btFemEntry& entry = m_impl->m_registry.entry(body);
    if (material.m_density > 0) writeMasses(*body, massesAtRest(entry, material.m_density));
    entry.m_material = coreMaterial(material);
    entry.m_materialGiven = true;
    entry.m_materialChanged = true;
    entry.m_rejected = false;
}

void btFemSoftBodySolver::setDetail(btSoftBody* body, btFemDetail detail)
{
    btFemEntry& entry = m_impl->m_registry.entry(body);
    entry.m_detail = detail;
    entry.m_detailLevel = {};
}

void btFemSoftBodySolver::setInterest(btFemInterest* interest, const btFemDetailPolicy& policy)
{
    m_impl->m_step.setInterest(interest, policy);
}

void btFemSoftBodySolver::prepare(btSoftBody* body, btScalar fixedTimeStep)
{
    btFemEntry& entry = m_impl->m_registry.entry(body);
    m_impl->m_registry.setUp(entry, fixedTimeStep);
    entry.m_rejected = false;
    m_impl->m_registry.chooseSurface(entry);
}

void btFemSoftBodySolver::useBaked(btSoftBody* body, const BakedBody& baked)
{
    ::useBaked(m_impl->m_registry, body, baked);
}

void btFemSoftBodySolver::refactor(btSoftBody* body)
{
    btFemEntry& entry = m_impl->femEntry(body, "refactor");
    readNodes(*entry.m_fem);
    const double step = entry.m_lastStep > 0 ? entry.m_lastStep : entry.m_fem->m_body.m_model->factorInput().m_step;
    m_impl->m_registry.refactor(entry, step);
    entry.m_factorAccount.clear();
    entry.m_factorJob.reset();
}

void btFemSoftBodySolver::setContactOffset(btSoftBody* body, btScalar metres)
{
    if (!(metres >= 0 && metres <= 1000))
        throw std::invalid_argument("contact offset " + std::to_string(metres) + " m is not in [0, 1000]");
    btFemEntry& entry = m_impl->m_registry.entry(body);
    entry.m_contactOffset = metres;
    if (!entry.m_fem) return;
    entry.m_fem->m_contactOffset = metres;
    entry.m_fem->m_surface.forgetPlace();  // what it touches is searched for again
}

void btFemSoftBodySolver::forget(btSoftBody* body)
{
    m_impl->m_registry.forget(body);
}

bool btFemSoftBodySolver::valid(const btSoftBody* body, std::string* why)
{
    const auto says = [why](const char* message)
    {
        if (why) *why = message;
        return false;
    };
    if (!body) return says("the soft body is null; give one made by btFemHelpers or btSoftBodyHelpers");
    if (body->m_tetras.size() == 0) return says("the soft body has no tetrahedra; make it with btFemHelpers");
    try
    {
        tetMeshOf(*body);
        return true;
    }
    catch (const std::exception& error)
    {
        return says(error.what());
    }
}

bool btFemSoftBodySolver::isFem(const btSoftBody* body) const
{
    const btFemEntry* entry = m_impl->m_registry.find(body);
    return entry && entry->m_fem;
}

const btFemStepReport& btFemSoftBodySolver::stepReport(const btSoftBody* body) const
{
    const btFemEntry* entry = m_impl->m_registry.find(body);
    return entry ? entry->m_report : m_impl->m_noReport;
}

const btAlignedObjectArray<btFemContact>& btFemSoftBodySolver::contacts(const btSoftBody* body) const
{
    const btFemEntry* entry = m_impl->m_registry.find(body);
    return entry ? entry->m_contacts : m_impl->m_noContacts;
}

const btAlignedObjectArray<btFemAnchorReport>& btFemSoftBodySolver::anchors(const btSoftBody* body) const
{
    const btFemEntry* entry = m_impl->m_registry.find(body);
    return entry ? entry->m_anchors : m_impl->m_noAnchors;
}

const btAlignedObjectArray<btFemTouch>& btFemSoftBodySolver::touches(const btSoftBody* body) const
{
    const btFemEntry* entry = m_impl->m_registry.find(body);
    return entry ? entry->m_touches : m_impl->m_noTouches;
}

btVector3 btFemSoftBodySolver::contactForce(const btSoftBody* body, const btCollisionObject* other) const
{
    const btFemEntry* entry = m_impl->m_registry.find(body);
    btVector3 sum(0, 0, 0);
    if (!entry || !(entry->m_lastStep > 0)) return sum;
    for (int k = 0; k < entry->m_contacts.size(); ++k)
        if (entry->m_contacts[k].m_other == other) sum += entry->m_contacts[k].m_impulse;
    return sum / static_cast<btScalar>(entry->m_lastStep);
}

bool btFemSoftBodySolver::getContactForces(const btSoftBody* body, btAlignedObjectArray<btVector3>& perNode) const
{
    const btFemEntry* entry = m_impl->m_registry.find(body);
    const bool known = entry && entry->m_fem && arraysAsSetUp(*entry->m_fem);
    perNode.resize(known ? body->m_nodes.size() : 0);
    for (int i = 0; i < perNode.size(); ++i) perNode[i].setZero();
    for (int k = 0; known && entry->m_lastStep > 0 && k < entry->m_contacts.size(); ++k)
    {
        const btFemContact& contact = entry->m_contacts[k];
        for (int a = 0; a < contact.m_nodeCount; ++a)
            if (contact.m_nodes[a] < perNode.size())  // prepare() may have found fewer nodes than the last step
                perNode[contact.m_nodes[a]] +=
                    contact.m_impulse * (contact.m_weights[a] / static_cast<btScalar>(entry->m_lastStep));
    }
    return known;
}

btFemContactGroup* btFemCoupling::beginGroup(btFemSoftBodySolver& fem, btCollisionObject* const* bodies, int count,
                                             double step)
{
    return fem.m_impl->m_step.beginGroup(fem.m_impl->m_registry, bodies, count, step);
}

btFemEntry& btFemCoupling::femEntry(btFemSoftBodySolver& fem, const btSoftBody* body, const char* caller)
{
    return fem.m_impl->femEntry(body, caller);
}

const btFemEntry* btFemCoupling::entry(const btFemSoftBodySolver& fem, const btSoftBody& body)
{
    return fem.m_impl->m_registry.find(&body);
}

void btFemCoupling::reportRejection(btFemSoftBodySolver& fem, btSoftBody& body, const std::string& why)
{
    btFemEntry& entry = fem.m_impl->m_registry.entry(&body);
    if (!entry.m_rejected) btFemBodyRegistry::reject(entry);
    entry.m_message = why;
    entry.m_report = {};
    entry.m_report.m_flags = BT_FEM_REJECTED;
    entry.m_report.m_message = entry.m_message.c_str();
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
    return {fem.m_impl->m_registry, fem.m_impl->m_step.group(), fem.m_impl->m_worldBodies};
}

void btFemSoftBodySolver::optimize(btAlignedObjectArray<btSoftBody*>& softBodies, bool forceUpdate)
{
    btDefaultSoftBodySolver::optimize(softBodies, forceUpdate);
    m_impl->m_worldBodies = &softBodies;
    m_impl->m_registry.synchronise(softBodies, this, m_impl->m_step.threads());
}

void btFemSoftBodySolver::predictMotion(btScalar timeStep)
{
    m_impl->dropRemovedBodies(m_softBodySet);
    m_impl->m_step.predict(m_impl->m_registry, timeStep);
    for (int i = 0; i < m_softBodySet.size(); ++i)
    {
        if (!m_impl->movesBySprings(m_softBodySet[i])) continue;
        if (m_impl->m_registry.find(m_softBodySet[i])) updateWithoutTree(*m_softBodySet[i]);
        m_softBodySet[i]->predictMotion(timeStep);
    }
}

void btFemSoftBodySolver::processCollision(btSoftBody* body, const btCollisionObjectWrapper* other)
{
    const btFemEntry* entry = m_impl->m_registry.find(body);
    if (!entry || entry->m_rejected)
    {
        if (hasUsableNodes(*body)) btDefaultSoftBodySolver::processCollision(body, other);
    }
    else if (entry->m_present && entry->m_fem && !ignoresRigidBodies(*body) &&
             other->getCollisionObject()->hasContactResponse() &&
             !ignoresCollision(*body, *other->getCollisionObject()))
    {
        wakeIfPushed(*entry, *other->getCollisionObject());
        recordTouching(*entry->m_fem, *other->getCollisionObject());
        m_impl->m_step.noteBeforeSolve(*other->getCollisionObject());
    }
}

void btFemSoftBodySolver::processCollision(btSoftBody* body, btSoftBody* other)
{
    const btFemEntry* entry = m_impl->m_registry.find(body);
    const bool fem = entry && entry->m_fem, otherFem = isFem(other);
    // Bullet's handlers would move a FEM body's nodes behind its back.
    if (!fem && !otherFem)
    {
        if (hasUsableNodes(*body) && hasUsableNodes(*other)) btDefaultSoftBodySolver::processCollision(body, other);
        return;
    }
    if (fem && otherFem && collide(*body, *other)) recordTouching(*entry->m_fem, *other);
}

void btFemSoftBodySolver::solveConstraints(btScalar timeStep)
{
    m_impl->dropRemovedBodies(m_softBodySet);
    m_impl->m_step.solve(m_impl->m_registry, timeStep);
    for (int i = 0; i < m_softBodySet.size(); ++i)
        if (m_impl->movesBySprings(m_softBodySet[i])) m_softBodySet[i]->solveConstraints();
}

void btFemSoftBodySolver::updateSoftBodies()
{
    m_impl->dropRemovedBodies(m_softBodySet);
    for (int i = 0; i < m_softBodySet.size(); ++i)
    {
        const btFemEntry* entry = m_impl->m_registry.find(m_softBodySet[i]);
        if (!(entry && entry->isStepped()) && m_softBodySet[i]->isActive()) m_softBodySet[i]->integrateMotion();
    }
    m_impl->m_step.updateSurfaces(m_impl->m_registry);
    updateSleep(m_impl->m_registry);
    if (m_impl->m_manifolds) m_impl->m_manifolds->update();
}
