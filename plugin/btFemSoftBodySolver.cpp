// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemSoftBodySolver.h"

#include <cmath>
#include <stdexcept>

#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/bullet_vectors.h"
#include "bullet_bridge/node_exchange.h"
#include "bullet_bridge/soft_body_mesh.h"
#include "bullet_fem/btFemHelpers.h"
#include "plugin/btFemBodyRegistry.h"
#include "plugin/btFemMaterialConversion.h"
#include "plugin/btFemWorldStep.h"

using namespace bullet_fem;

struct btFemSoftBodySolver::Impl
{
    explicit Impl(const btFemSolverInfo& info) : m_step(info) {}

    btFemEntry& femEntry(const btSoftBody* body, const char* caller)
    {
        btFemEntry* entry = m_registry.find(body);
        if (!entry || !entry->m_fem)
            throw std::invalid_argument(
                std::string(caller) +
                ": the body is not moved by finite elements; call prepare() or step its world first");
        return *entry;
    }

    // Tick callbacks run within a step, and may remove and delete soft bodies; Bullet tells nobody.
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
            if (entry->m_present && !isHeld(entry->m_softBody)) entry->m_present = false;
    }

    bool movesBySprings(const btSoftBody* body) const
    {
        const btFemEntry* entry = m_registry.find(body);
        return body->isActive() && (!entry || (entry->m_rejected && entry->m_present));
    }

    const btAlignedObjectArray<btSoftBody*>* m_worldBodies = nullptr;  // of the world being stepped
    btFemBodyRegistry m_registry;
    btFemWorldStep m_step;
    const btFemStepReport m_noReport;
    const btAlignedObjectArray<btFemContact> m_noContacts;
};

namespace
{

void checkNode(const btSoftBody& body, int node)
{
    if (node < 0 || node >= body.m_nodes.size())
        throw std::invalid_argument("node " + std::to_string(node) + " is not in [0, " +
                                    std::to_string(body.m_nodes.size()) + ") of this body");
}

// The masses that a density gives; pinned nodes stay pinned.
void writeMasses(btSoftBody& body, double density)
{
    const std::vector<double> mass = massesOf(tetMeshOf(body), filledFractionsOf(body), density * massScaleOf(body));
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (body.m_nodes[i].m_im != 0) body.m_nodes[i].m_im = static_cast<btScalar>(1 / mass[i]);
    body.m_bUpdateRtCst = true;
}

// True if all rigid contact was switched off with m_cfg.collisions.
bool ignoresRigidBodies(const btSoftBody& body)
{
    using Flags = btSoftBody::fCollision;
    return (body.m_cfg.collisions & (Flags::RVSmask | Flags::RVDFmask)) == 0 || !body.hasContactResponse();
}

bool check(bool good, std::string* why, const char* name, double value, const char* range)
{
    if (!good && why) *why = std::string(name) + " is " + std::to_string(value) + ", not in " + range;
    return good;
}

}  // namespace

bool btFemSolverInfo::valid(std::string* why) const
{
    return check(m_tolerance >= btScalar(1e-8) && m_tolerance <= btScalar(0.5), why, "m_tolerance", m_tolerance,
                 "[1e-8, 0.5]; 1e-3 is usual") &&
           check(m_maxIterations >= 1 && m_maxIterations <= 10000, why, "m_maxIterations", m_maxIterations,
                 "[1, 10000]; 100 is usual") &&
           check(m_contactRounds >= 1 && m_contactRounds <= 10, why, "m_contactRounds", m_contactRounds,
                 "[1, 10]; 2 is usual") &&
           check(m_contactSweeps >= 1 && m_contactSweeps <= 1000, why, "m_contactSweeps", m_contactSweeps,
                 "[1, 1000]; 50 is usual") &&
           check(m_maxContacts >= 8 && m_maxContacts <= 20000, why, "m_maxContacts", m_maxContacts,
                 "[8, 20000]; 2000 is usual") &&
           check(m_erp >= 0 && m_erp <= 1, why, "m_erp", m_erp, "[0, 1]; 0.2 is usual") &&
           check(m_maxPushVelocity >= 0 && m_maxPushVelocity <= 1000, why, "m_maxPushVelocity", m_maxPushVelocity,
                 "[0, 1000] m/s; 1 is usual");
}

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
    if (!valid(body, &why)) throw std::invalid_argument("setMaterial: " + why);
    if (material.m_density > 0) writeMasses(*body, material.m_density);
    btFemEntry& entry = m_impl->m_registry.entry(body);
    entry.m_material = coreMaterial(material);
    entry.m_materialGiven = true;
    entry.m_materialChanged = true;
    entry.m_rejected = false;
}

void btFemSoftBodySolver::setDetail(btSoftBody* body, btFemDetail detail)
{
    m_impl->m_registry.entry(body).m_detail = detail;
}

void btFemSoftBodySolver::prepare(btSoftBody* body, btScalar fixedTimeStep)
{
    btFemEntry& entry = m_impl->m_registry.entry(body);
    m_impl->m_registry.setUp(entry, fixedTimeStep);
    entry.m_rejected = false;
}

void btFemSoftBodySolver::refactor(btSoftBody* body)
{
    btFemEntry& entry = m_impl->femEntry(body, "refactor");
    readNodes(*entry.m_fem);
    const double step = entry.m_lastStep > 0 ? entry.m_lastStep : entry.m_fem->m_body.m_model->factorInput().m_step;
    m_impl->m_registry.refactor(entry, step);
}

void btFemSoftBodySolver::setNodeTarget(btSoftBody* body, int node, const btVector3& position)
{
    btFemEntry& entry = m_impl->femEntry(body, "setNodeTarget");
    checkNode(*body, node);
    if (!isFinite(vec3(position)))
        throw std::invalid_argument("setNodeTarget: the position of node " + std::to_string(node) + " is not finite");
    entry.m_fem->m_pins.m_position[node] = vec3(position);
    entry.m_fem->m_pins.m_hasTarget[node] = 1;
}

void btFemSoftBodySolver::clearNodeTarget(btSoftBody* body, int node)
{
    btFemEntry& entry = m_impl->femEntry(body, "clearNodeTarget");
    checkNode(*body, node);
    entry.m_fem->m_pins.m_hasTarget[node] = 0;
}

void btFemSoftBodySolver::setContactOffset(btSoftBody* body, btScalar metres)
{
    if (!(metres >= 0 && metres <= 1000))
        throw std::invalid_argument("contact offset " + std::to_string(metres) + " m is not in [0, 1000]");
    btFemEntry& entry = m_impl->m_registry.entry(body);
    entry.m_contactOffset = metres;
    if (entry.m_fem) entry.m_fem->m_contactOffset = metres;
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

btVector3 btFemSoftBodySolver::contactForce(const btSoftBody* body, const btCollisionObject* other) const
{
    const btFemEntry* entry = m_impl->m_registry.find(body);
    btVector3 sum(0, 0, 0);
    if (!entry || !(entry->m_lastStep > 0)) return sum;
    for (int k = 0; k < entry->m_contacts.size(); ++k)
        if (entry->m_contacts[k].m_other == other) sum += entry->m_contacts[k].m_impulse;
    return sum / static_cast<btScalar>(entry->m_lastStep);
}

void btFemSoftBodySolver::optimize(btAlignedObjectArray<btSoftBody*>& softBodies, bool forceUpdate)
{
    btDefaultSoftBodySolver::optimize(softBodies, forceUpdate);
    m_impl->m_worldBodies = &softBodies;
    m_impl->m_registry.synchronise(softBodies, this);
}

void btFemSoftBodySolver::predictMotion(btScalar timeStep)
{
    m_impl->dropRemovedBodies(m_softBodySet);
    m_impl->m_step.predict(m_impl->m_registry, timeStep);
    for (int i = 0; i < m_softBodySet.size(); ++i)
        if (m_impl->movesBySprings(m_softBodySet[i])) m_softBodySet[i]->predictMotion(timeStep);
}

void btFemSoftBodySolver::processCollision(btSoftBody* body, const btCollisionObjectWrapper* other)
{
    const btFemEntry* entry = m_impl->m_registry.find(body);
    if (!entry || entry->m_rejected)
        btDefaultSoftBodySolver::processCollision(body, other);
    else if (entry->m_present && entry->m_fem && !ignoresRigidBodies(*body) &&
             other->getCollisionObject()->hasContactResponse())
        recordTouching(*entry->m_fem, *other->getCollisionObject());
}

void btFemSoftBodySolver::processCollision(btSoftBody* body, btSoftBody* other)
{
    // Bullet's handlers would move a FEM body's nodes behind its back.
    if (!isFem(body) && !isFem(other)) btDefaultSoftBodySolver::processCollision(body, other);
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
    btDefaultSoftBodySolver::updateSoftBodies();
    for (const auto& entry : m_impl->m_registry.entries())
        if (entry->m_present && entry->m_fem && entry->m_softBody->isActive())
            btFemHelpers::updateEmbeddedSurface(entry->m_softBody);
}
