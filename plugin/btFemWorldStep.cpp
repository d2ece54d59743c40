// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/btFemWorldStep.h"

#include <algorithm>
#include <chrono>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/bullet_vectors.h"
#include "bullet_bridge/node_exchange.h"
#include "bullet_fem/fem/stepping.h"

using namespace bullet_fem;

namespace
{

constexpr double kSameFactor = 1 + 1e-5;    // ratio of step or mass up to which a factor is not called stale
constexpr double kRefactorInContact = 1.5;  // and beyond which a body that touches something is factored anew

class Stopwatch
{
public:
    double milliseconds() const
    {
        return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
    }

private:
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

// What predictMotion of btSoftBody does besides moving nodes, without resetting the links' rest lengths.
void refreshBulletConstants(btSoftBody& soft, double step)
{
    if (soft.m_bUpdateRtCst)
    {
        soft.m_bUpdateRtCst = false;
        soft.updateLinkConstants();
        soft.updateArea();
    }
    soft.m_sst.sdt = static_cast<btScalar>(step);
    soft.m_sst.isdt = 1 / soft.m_sst.sdt;
    soft.m_sst.velmrg = soft.m_sst.sdt * 3;
    soft.m_sst.radmrg = soft.getCollisionShape()->getMargin();
    soft.m_sst.updmrg = soft.m_sst.radmrg * btScalar(0.25);
    soft.m_rcontacts.resizeNoInitialize(0);
    soft.m_scontacts.resizeNoInitialize(0);
}

// A body's own step: Bullet scales time by m_cfg.timescale.
double bodyStep(const btFemEntry& entry, double worldStep)
{
    return worldStep * entry.m_softBody->m_cfg.timescale;
}

bool isFinite(const std::vector<Vec3>& values)
{
    return std::all_of(values.begin(), values.end(), [](const Vec3& v) { return bullet_fem::isFinite(v); });
}

void clearReport(btFemEntry& entry)
{
    btFemStepReport report;
    report.m_flags = entry.m_report.m_flags | entry.m_setUpFlags | (entry.m_rejected ? BT_FEM_REJECTED : 0);
    report.m_message = entry.m_message.c_str();
    if (entry.m_fem)
    {
        const BodyModel& model = *entry.m_fem->m_body.m_model;
        report.m_nodes = model.nodeCount();
        report.m_tets = model.mesh().tetCount();
        report.m_factorEntries = model.factorReport().m_entries;
        report.m_factorSeconds = static_cast<btScalar>(model.factorReport().m_seconds);
    }
    entry.m_report = report;
}

void note(btFemEntry& entry, const SolveReport& solved)
{
    if (solved.m_stop == SolveStop::budget) entry.m_report.m_flags |= BT_FEM_NOT_CONVERGED;
    if (solved.m_stop == SolveStop::breakdown) entry.m_report.m_flags |= BT_FEM_BREAKDOWN;
}

btFemContact publicContact(const ContactPoint& point, const ContactOrigin& origin)
{
    btFemContact contact;
    contact.m_point = bulletVector(point.m_point);
    contact.m_normal = bulletVector(point.m_normal);
    contact.m_gap = static_cast<btScalar>(point.m_gap);
    contact.m_impulse = bulletVector(point.m_impulse);
    contact.m_other = origin.m_object;
    for (int a = 0; a < 3; ++a)
    {
        contact.m_nodes[a] = point.m_nodes[a];
        contact.m_weights[a] = static_cast<btScalar>(point.m_weights[a]);
    }
    return contact;
}

}  // namespace

bool isUsableStep(double step)
{
    return step >= 1e-6 && step <= 1;
}

StepSettings btFemWorldStep::settingsOf(const btFemEntry& entry) const
{
    StepSettings settings;
    settings.m_step = entry.m_lastStep;
    settings.m_tolerance = m_info.m_tolerance;
    settings.m_maxIterations = m_info.m_maxIterations;
    settings.m_warp = entry.m_detail == btFemDetail::nodalWarp ? Warp::nodal : Warp::global;
    settings.m_direct = entry.m_detail == btFemDetail::direct && entry.m_contacts.size() == 0;
    return settings;
}

void btFemWorldStep::predict(btFemBodyRegistry& registry, double step)
{
    for (const auto& pointer : registry.entries())
    {
        btFemEntry& entry = *pointer;
        btSoftBody& soft = *entry.m_softBody;
        if (!entry.m_present || entry.m_rejected || !soft.isActive()) continue;
        const double h = bodyStep(entry, step);
        if (!isUsableStep(h)) continue;
        if (!entry.m_fem || entry.m_materialChanged) registry.trySetUp(entry, h);
        if (!entry.m_fem) continue;

        readBody(entry);
        // Without contact a stale factor costs iterations only; contact would rest on a wrong picture of the
        // compliance.
        if (entry.m_contacts.size() > 0 && factorMismatch(*entry.m_fem, h) > kRefactorInContact)
        {
            registry.refactor(entry, h);
            entry.m_report.m_flags |= BT_FEM_REFACTORED;
        }
        refreshBulletConstants(soft, h);
        soft.applyForces();
        setSweptBounds(*entry.m_fem, h, 0.1 * entry.m_fem->m_body.m_model->mesh().meanEdgeLength());
        entry.m_fem->m_touching.clear();
    }
}

void btFemWorldStep::readBody(btFemEntry& entry)
{
    const NodeReadReport read = readNodes(*entry.m_fem);
    if (read.m_restored) entry.m_report.m_flags |= BT_FEM_RESTORED;
    if (read.m_badMass) entry.m_report.m_flags |= BT_FEM_BAD_MASS;
    if (read.m_stalePins) entry.m_report.m_flags |= BT_FEM_STALE_FACTOR;
}

void btFemWorldStep::collectActive(btFemBodyRegistry& registry, double worldStep)
{
    m_active.clear();
    for (const auto& pointer : registry.entries())
    {
        btFemEntry& entry = *pointer;
        if (!entry.m_present) continue;
        if (!entry.m_fem || entry.m_softBody->isActive()) clearReport(entry);
        if (!entry.m_fem || !entry.m_softBody->isActive()) continue;
        entry.m_lastStep = bodyStep(entry, worldStep);
        if (isUsableStep(entry.m_lastStep))
            m_active.push_back(&entry);
        else
            entry.m_report.m_flags |= BT_FEM_BAD_STEP;
    }
}

void btFemWorldStep::solve(btFemBodyRegistry& registry, double step)
{
    collectActive(registry, step);
    for (btFemEntry* entry : m_active)
    {
        readBody(*entry);  // once more: callbacks may have written since predict
        solveFree(*entry);
    }
    solveContacts(step);
    for (btFemEntry* entry : m_active) finish(*entry);
}

void btFemWorldStep::solveFree(btFemEntry& entry)
{
    const Stopwatch watch;
    FemSoftBody& fem = *entry.m_fem;
    if (!readLoads(fem, entry.m_lastStep)) entry.m_report.m_flags |= BT_FEM_RESTORED;
    if (factorMismatch(fem, entry.m_lastStep) > kSameFactor) entry.m_report.m_flags |= BT_FEM_STALE_FACTOR;
    const StepSettings settings = settingsOf(entry);
    const SolveReport solved = solveFreeMotion(fem.m_body, settings);
    if (!settings.m_direct) note(entry, solved);
    entry.m_report.m_iterations = solved.m_iterations;
    entry.m_report.m_residual = static_cast<btScalar>(solved.m_residual);
    entry.m_report.m_freeMotionMs = static_cast<btScalar>(watch.milliseconds());
}

void btFemWorldStep::solveContacts(double step)
{
    const Stopwatch watch;
    findContacts(step);
    ContactSettings settings;
    settings.m_step.m_step = step;
    settings.m_step.m_tolerance = m_info.m_tolerance;
    settings.m_step.m_maxIterations = m_info.m_maxIterations;
    settings.m_rounds = m_info.m_contactRounds;
    settings.m_sweeps = m_info.m_contactSweeps;
    settings.m_pushFraction = m_info.m_erp;
    settings.m_maxPushVelocity = m_info.m_maxPushVelocity;
    const ContactReport report = m_solver.solve(m_contactBodies, m_rigid.obstacles(), m_contacts, settings);
    m_rigid.applyReactions(m_contacts, step);
    splitContacts(report, watch.milliseconds());
}

void btFemWorldStep::findContacts(double step)
{
    m_rigid.clear();
    m_contacts.clear();
    m_contactBodies.clear();
    for (std::size_t b = 0; b < m_active.size(); ++b)
    {
        FemSoftBody& fem = *m_active[b]->m_fem;
        const ContactSearchReport found = m_finder.find(fem, static_cast<int>(b), step, m_info.m_maxContacts, m_rigid);
        if (found.m_unknownShape) m_active[b]->m_report.m_flags |= BT_FEM_UNKNOWN_SHAPE;
        if (found.m_limited) m_active[b]->m_report.m_flags |= BT_FEM_CONTACT_LIMIT;
        m_contactBodies.push_back({&fem.m_body, fem.m_compliance.get()});
        m_contacts.insert(m_contacts.end(), fem.m_contacts.begin(), fem.m_contacts.end());
    }
}

// Gives every body its share of the contacts and of the report back.
void btFemWorldStep::splitContacts(const ContactReport& report, double milliseconds)
{
    auto next = m_contacts.begin();
    for (std::size_t b = 0; b < m_active.size(); ++b)
    {
        btFemEntry& entry = *m_active[b];
        FemSoftBody& fem = *entry.m_fem;
        entry.m_report.m_contactMs = static_cast<btScalar>(milliseconds);
        entry.m_contacts.resize(0);
        std::copy(next, next + fem.m_contacts.size(), fem.m_contacts.begin());
        next += fem.m_contacts.size();
        if (fem.m_contacts.empty()) continue;
        entry.m_report.m_contacts = static_cast<int>(fem.m_contacts.size());
        entry.m_report.m_contactSweeps = report.m_sweeps;
        entry.m_report.m_contactIterations = report.m_iterations;
        entry.m_report.m_contactViolation = static_cast<btScalar>(report.m_violation);
        if (!report.m_converged) entry.m_report.m_flags |= BT_FEM_NOT_CONVERGED;
        double deepest = 0;
        for (std::size_t k = 0; k < fem.m_contacts.size(); ++k)
        {
            entry.m_contacts.push_back(publicContact(fem.m_contacts[k], fem.m_origins[k]));
            deepest = std::max(deepest, -fem.m_contacts[k].m_gap);
        }
        entry.m_report.m_deepestPenetration = static_cast<btScalar>(deepest);
    }
}

void btFemWorldStep::finish(btFemEntry& entry)
{
    FemSoftBody& fem = *entry.m_fem;
    if (isFinite(velocity(fem.m_body)))
        finishStep(fem.m_body, settingsOf(entry));
    else  // no NaN may reach a node: stand still instead
    {
        entry.m_report.m_flags |= BT_FEM_BREAKDOWN;
        std::fill(fem.m_body.m_state.m_v.begin(), fem.m_body.m_state.m_v.end(), Vec3());
    }
    writeNodes(fem);
}
