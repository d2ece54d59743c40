// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemContactGroup.h"

#include <algorithm>
#include <utility>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/common/threads.h"
#include "fem/common/chunks.h"
#include "plugin/joints/btFemAttachments.h"
#include "plugin/record/btFemStopwatch.h"

using namespace bullet_fem;

namespace
{

constexpr int kContactsPerChunk = 256;  // contacts copied by one task

// Largest impact speed without restitution [m/s], as Bullet's m_restitutionVelocityThreshold.
constexpr double kRestitutionVelocity = 0.2;

// The defaults of the user's settings are those of the solver.
static_assert(btFemSolverInfo().m_contactSweeps == ContactSettings().m_sweeps);
static_assert(btFemSolverInfo().m_contactRounds == ContactSettings().m_rounds);

}  // namespace

void btFemContactGroup::beginStep(double step)
{
    m_rigid.history().beginStep(step);
    m_rigid.links().beginStep();
    m_rigidSearch.beginStep();
    m_softPairs.beginStep();
    m_cloth.beginStep();
    m_joints.forgetWorld();
}

// Clears the problem, but keeps the capacity of the contact array, which is its largest part.
void btFemContactGroup::clearProblem()
{
    std::vector<ContactPoint> contacts = std::move(m_problem.m_contacts);
    m_problem.clear();
    contacts.swap(m_problem.m_contacts);
}

void btFemContactGroup::collect(const Scope& scope)
{
    const btFemStopwatch watch;
    m_step = scope.m_step;
    m_records = scope.m_records;
    const btFemIsland island = scope.m_island ? *scope.m_island : btFemIsland();
    m_rigid.clear(scope.m_phase, scope.m_rewind, island.m_constraints, island.m_constraintCount);
    clearProblem();
    m_bodies.clear();
    for (btFemBodyRecord* record : m_records)
    {
        FemSoftBody& fem = record->fem();
        m_bodies.push_back(&fem);
        m_problem.m_bodies.push_back({&fem.m_body, fem.m_compliance.get(),
                                      fem.m_memory.m_predicted.empty() ? nullptr : &fem.m_memory.m_predicted});
    }
    collectJoints(scope);  // first: joints decide whether the rigid bodies that they hold are rewound
    for (FemSoftBody* fem : m_bodies) fem->holdForSearches(true);
    findRigid();
    findSoft();
    findCloth();
    for (FemSoftBody* fem : m_bodies) fem->holdForSearches(false);
    for (std::size_t b = 0; b < m_bodies.size(); ++b)
        m_problem.m_bodies[b].m_compliance = m_bodies[b]->m_compliance.get();  // inner nodes may have been exposed
    collectContacts();
    m_torsionalPatches.append(m_bodies, m_problem);
    m_rigid.links().connect(m_rigid.rigidProxies(), m_problem.m_responses);
    if (scope.m_phase == RigidPhase::moved && (!m_problem.m_contacts.empty() || m_rigid.holdsRewound()))
        findRigidContacts();
    addIsland(scope);
    m_problem.m_rigidProxies.assign(m_rigid.rigidProxies().begin(), m_rigid.rigidProxies().end());
    m_cloth.append(m_step, m_problem);
    listOverlaps();
    m_settings.m_step.m_step = m_step;
    m_settings.m_step.m_numericalDamping = m_info.m_numericalDamping;
    m_settings.m_step.m_tolerance = m_info.m_tolerance;
    m_settings.m_step.m_maxIterations = m_info.m_maxIterations;
    m_settings.m_rounds = m_info.m_contactRounds;
    m_settings.m_sweeps = m_info.m_contactSweeps;
    m_settings.m_tolerance = m_info.m_contactTolerance;
    if (mayRebound(m_problem)) m_settings.m_tolerance = std::min(m_settings.m_tolerance, kReboundTolerance);
    m_settings.m_pushFraction = m_info.m_erp;
    m_settings.m_maxPushVelocity = m_info.m_maxPushVelocity;
    m_milliseconds = watch.milliseconds();
}

void btFemContactGroup::findRigidContacts()
{
    const btSoftBodyWorldInfo* world = m_bodies.empty() ? nullptr : m_bodies.front()->m_softBody->m_worldInfo;
    if (world && world->m_dispatcher)
        m_rigidContactFinder.find(*world->m_dispatcher, m_step, m_rigid, m_problem.m_rigidContacts);
}

// Every movable body that Bullet solves with the group is a rigid proxy.
void btFemContactGroup::addIsland(const Scope& scope)
{
    for (int k = 0; scope.m_island && k < scope.m_island->m_objectCount; ++k)
        if (const btCollisionObject& object = *scope.m_island->m_objects[k]; movableBody(object))
            m_rigid.indexOf(object, m_step);
    if (!scope.m_rewind) return;
    m_met.clear();
    const auto meet = [this](int rigidProxy)
    {
        if (rigidProxy >= 0) m_met.push_back(&m_rigid.object(rigidProxy));
    };
    for (const ContactPoint& contact : m_problem.m_contacts) meet(contact.m_rigidProxy);
    for (const Joint& joint : m_problem.m_joints)
        for (const JointEnd* end : {&joint.m_a, &joint.m_b}) meet(end->m_rigidProxy);
    scope.m_rewind->keepOnly(m_met);
    for (const btCollisionObject* body : scope.m_rewind->bodies()) m_rigid.indexOf(*body, m_step);
}

void btFemContactGroup::findRigid()
{
    m_rigidSearch.find(m_bodies, m_step, m_info.m_maxContacts, m_rigid);
    for (std::size_t b = 0; b < m_bodies.size(); ++b)
    {
        const ContactSearchReport& found = m_rigidSearch.reports()[b];
        if (found.m_unknownShape) m_records[b]->m_reports.m_step.m_flags |= BT_FEM_UNKNOWN_SHAPE;
        if (found.m_limited) m_records[b]->m_reports.m_step.m_flags |= BT_FEM_CONTACT_LIMIT;
        if (found.m_encloses) m_records[b]->m_reports.m_step.m_flags |= BT_FEM_PENETRATING;
        m_records[b]->m_work.m_sleep.m_enclosesObject = found.m_encloses;
    }
}

// The bodies are in the order of the problem, which does not depend on addresses.
void btFemContactGroup::findSoft()
{
    m_softPairs.find(m_bodies, m_step, m_info.m_maxContacts);
    for (std::size_t b = 0; b < m_bodies.size(); ++b)
        if (m_softPairs.isLimited(b)) m_records[b]->m_reports.m_step.m_flags |= BT_FEM_CONTACT_LIMIT;
}

void btFemContactGroup::findCloth()
{
    m_cloth.find(m_bodies, m_step, m_info.m_maxContacts, *m_settings.m_step.m_threads);
    for (std::size_t b = 0; b < m_bodies.size(); ++b)
    {
        auto& flags = m_records[b]->m_reports.m_step.m_flags;
        if (m_cloth.isLimited(b)) flags |= BT_FEM_CONTACT_LIMIT;
        if (std::exchange(m_bodies[b]->m_joints.m_clothIsLost, false)) flags |= BT_FEM_LOST_ANCHOR;
    }
}

// Copies contacts with rigid objects body by body, then those between soft bodies; cloth contacts are appended later.
void btFemContactGroup::collectContacts()
{
    m_firstRigid.assign(1, 0);
    for (const FemSoftBody* fem : m_bodies)
        m_firstRigid.push_back(m_firstRigid.back() + fem->m_memory.m_contacts.size());
    const std::vector<ContactPoint>& soft = m_softPairs.contacts();
    std::vector<ContactPoint>& contacts = m_problem.m_contacts;
    contacts.resize(m_firstRigid.back() + soft.size());
    const auto place = [&contacts](std::size_t k) { return contacts.begin() + static_cast<std::ptrdiff_t>(k); };
    const int bodies = static_cast<int>(m_bodies.size());
    const Chunks pieces(static_cast<int>(soft.size()), kContactsPerChunk);
    const auto copy = [&](int k)
    {
        if (k < bodies)
        {
            std::vector<ContactPoint>& own = m_bodies[k]->m_memory.m_contacts;
            alignLinks(own);
            std::copy(own.begin(), own.end(), place(m_firstRigid[k]));
            return;
        }
        const Range piece = pieces[k - bodies];
        std::copy(soft.begin() + piece.m_begin, soft.begin() + piece.m_end, place(m_firstRigid.back() + piece.m_begin));
    };
    m_settings.m_step.m_threads->run(bodies + pieces.count(), copy);
}

void btFemContactGroup::listOverlaps()
{
    m_touches.assign(m_records.size(), 0);
    for (const ContactPoint& contact : m_problem.m_contacts)
        for (const int body : {contact.m_soft.m_body, contact.m_other.m_body})
            if (body >= 0) m_touches[body] = 1;
    m_overlapping.clear();
    for (std::size_t b = 0; b < m_records.size(); ++b)
        if (m_touches[b] != 0) m_overlapping.push_back(m_records[b]);
}

// Links move on arcs: momenta are conserved only if both sides share one contact point.
void btFemContactGroup::alignLinks(std::vector<ContactPoint>& contacts) const
{
    for (ContactPoint& contact : contacts)
        if (isMovableLink(m_rigid, contact.m_rigidProxy)) contact.m_approach = {};
}

void btFemContactGroup::collectJoints(const Scope& scope)
{
    m_outside.clear();
    for (const auto& record : scope.m_all)
        if (record->m_membership.m_present && record->isFem() &&
            std::find(m_records.begin(), m_records.end(), record.get()) == m_records.end())
            m_outside.push_back(&record->fem());
    m_joints.append({m_bodies, m_outside, m_rigid, m_step}, m_problem, m_jointFlags);
    const auto joins = [this](const FemSoftBody* other)
    { return other->m_softBody->isActive() && reachesInto(*other, m_bodies); };
    m_reachesOut = std::any_of(m_outside.begin(), m_outside.end(), joins);
    for (std::size_t b = 0; b < m_bodies.size(); ++b)
    {
        if (m_jointFlags[b].m_lost) m_records[b]->m_reports.m_step.m_flags |= BT_FEM_LOST_ANCHOR;
        if (m_jointFlags[b].m_bad) m_records[b]->m_reports.m_step.m_flags |= BT_FEM_BAD_ANCHOR;
        m_reachesOut = m_reachesOut || m_jointFlags[b].m_outside;
    }
}

bool btFemContactGroup::holdsOnly(const btFemIsland& island, bool linksToo) const
{
    if (m_reachesOut || (!m_rigid.links().isEmpty() && !linksToo)) return false;
    btCollisionObject* const* end = island.m_objects + island.m_objectCount;
    for (int k = 0; k < static_cast<int>(m_rigid.rigidProxies().size()); ++k)
        if ((movableBody(m_rigid.object(k)) || isMovableLink(m_rigid, k)) &&
            std::find(island.m_objects, end, &m_rigid.object(k)) == end)
            return false;
    return true;
}

// Call it after the solve, before its impulses are applied.
void btFemContactGroup::noteImpacts()
{
    m_rebounds.note(m_problem, m_bodies, m_rigid, m_step, kRestitutionVelocity);
}

void btFemContactGroup::solve()
{
    const btFemStopwatch watch;
    const ContactReport solved = m_solver.solve(m_problem, m_settings);
    noteImpacts();
    moveRigid();
    m_milliseconds += watch.milliseconds();
    report(solved);
}

// Runs a part of the solve with the velocities of the rigid solver's bodies, and writes the result back to them.
template <class Part>
void btFemContactGroup::onSolverBodies(const Part& part)
{
    const btFemStopwatch watch;
    m_solverBodies.read(m_problem.m_rigidProxies);
    part();
    m_solverBodies.write(m_problem.m_rigidProxies);
    m_milliseconds += watch.milliseconds();
}

void btFemContactGroup::solveWith(const BulletConstraints& bullet, const MultiBodyConstraints* links)
{
    const btFemStopwatch watch;
    m_solverBodies.begin(m_rigid, bullet.m_bodies, nullptr);
    m_bulletRows.append(bullet, m_solverBodies.proxyOf(), m_problem);
    if (m_bulletRows.anyBad())
        for (btFemBodyRecord* record : m_records) record->m_reports.m_step.m_flags |= BT_FEM_BAD_CONSTRAINT;
    m_solverBodies.read(m_problem.m_rigidProxies);
    if (links) m_multiBodyRows.append({bullet, *links, m_solverBodies.proxyOf(), m_rigid, m_problem});
    if (links && links->m_joints.size() + links->m_contacts.size() > 0)
        m_settings.m_tolerance = std::min(m_settings.m_tolerance, kToleranceWithRows);
    const ContactReport solved = m_solver.solve(m_problem, m_settings);
    noteImpacts();
    if (links) m_multiBodyRows.takeBack({bullet, *links, m_solverBodies.proxyOf(), m_rigid, m_problem});
    m_bulletRows.takeBack(bullet, m_problem);
    m_solverBodies.write(m_problem.m_rigidProxies);
    m_solverBodies.end(m_rigid);
    m_milliseconds += watch.milliseconds();
    report(solved);
}

// Bullet's rows need the outer iterations, too.
void btFemContactGroup::begin(btAlignedObjectArray<btSolverBody>& pool, btAlignedObjectArray<btScalar>& linkDeltas)
{
    if (!m_problem.m_contacts.empty()) findRigidContacts();
    m_settings.m_tolerance = std::min(m_settings.m_tolerance, kToleranceWithRows);
    m_solverBodies.begin(m_rigid, pool, &linkDeltas);
    onSolverBodies([this] { m_solver.begin(m_problem, m_settings); });
}

bool btFemContactGroup::sweep(double others)
{
    bool moves = false;
    onSolverBodies([&] { moves = m_solver.sweep(others); });
    return moves;
}

void btFemContactGroup::correct()
{
    onSolverBodies([this] { m_solver.correct(); });
}

void btFemContactGroup::restoreBest()
{
    onSolverBodies([this] { m_solver.restoreBest(); });
}

void btFemContactGroup::finish()
{
    ContactReport solved;
    onSolverBodies([&] { solved = m_solver.finish(); });
    noteImpacts();
    m_solverBodies.end(m_rigid);
    report(solved);
}

void btFemContactGroup::moveRigid()
{
    std::copy_n(m_problem.m_rigidProxies.begin(), m_rigid.rigidProxies().size(), m_rigid.rigidProxies().begin());
    m_rigid.applyReactions(m_problem, m_step);
    m_cloth.applyReactions(m_problem);
}

void btFemContactGroup::giveRebounds(const std::vector<btFemBodyRecord*>& records, WorldObjects& world, double step)
{
    const auto hasImpacts = [](const btFemBodyRecord* record) { return !record->fem().m_memory.m_impacts.empty(); };
    if (std::none_of(records.begin(), records.end(), hasImpacts)) return;
    m_bodies.clear();
    for (btFemBodyRecord* record : records) m_bodies.push_back(&record->fem());
    m_rebounds.give(m_bodies, world, m_rigid, step);
    for (const GivenRebound& given : m_rebounds.given()) reportRebound(given, records);
}
