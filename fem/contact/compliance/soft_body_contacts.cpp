// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/soft_body_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"
#include "fem/contact/contact_tuning.h"
#include "fem/factor/rest_factor.h"
#include "fem/solve/warped_compliance.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{
namespace
{

constexpr int kSamples = 16;  // sides from which the diagonal of W is estimated

double speedByLoads(const Body& body, double step)
{
    Vec3 force;
    double mass = 0;
    for (std::size_t i = 0; i < body.m_loads.m_force.size(); ++i)
    {
        force += body.m_loads.m_force[i];
        mass += body.m_state.m_mass[i];
    }
    return mass > 0 ? step * norm(force) / mass : 0;
}

}  // namespace

void SoftBodyContacts::clear(const ContactBody& body, const StepSettings& settings)
{
    m_body = body;
    m_settings = settings;
    m_settings.m_threads = nullptr;  // bodies share the threads
    m_step = settings.m_step;
    m_theta = StepCoefficients(settings, *body.m_body).theta();
    const std::vector<double>& mass = body.m_body->m_state.m_mass;
    if (m_theta < 1) m_mass = std::accumulate(mass.begin(), mass.end(), 0.0);
    m_added = 0;
    m_firstJoint = std::numeric_limits<int>::max();
    m_working.clear();
}

void SoftBodyContacts::setPoint(int e, const SurfacePoint& point, const Vec3& at)
{
    m_ends[e].m_point = point;
    m_ends[e].m_nodes = nullptr;
    m_ends[e].m_offset = at - read(m_ends[e], m_body.m_body->m_workspace.scratch().m_kickPosition);
}

int SoftBodyContacts::addGroup(const int* nodes, const Mat3* blocks, int count, bool actsAtStart)
{
    End end;
    end.m_nodes = nodes;
    end.m_blocks = blocks;
    end.m_count = count;
    end.m_actsAtStart = actsAtStart;
    m_ends.push_back(end);
    return size() - 1;
}

Vec3 SoftBodyContacts::read(const End& end, const std::vector<Vec3>& nodeValues) const
{
    Vec3 sum;
    if (isGroup(end))
        for (int i = 0; i < end.m_count; ++i) sum += end.m_blocks[i] * nodeValues[end.m_nodes[i]];
    else
        for (int a = 0; a < end.m_point.m_count; ++a)
            sum += end.m_point.m_weights[a] * nodeValues[end.m_point.m_nodes[a]];
    return sum;
}

void SoftBodyContacts::scatter(const End& end, const Vec3& impulse, std::vector<Vec3>& nodeImpulses) const
{
    if (isGroup(end))
        for (int i = 0; i < end.m_count; ++i) nodeImpulses[end.m_nodes[i]] += transposeTimes(end.m_blocks[i], impulse);
    else
        for (int a = 0; a < end.m_point.m_count; ++a)
            nodeImpulses[end.m_point.m_nodes[a]] += end.m_point.m_weights[a] * impulse;
}

void SoftBodyContacts::assemble(int denseLimit, double step)
{
    const std::size_t nodes = m_body.m_body->m_state.m_x.size();
    double& learnt = m_body.m_body->m_workspace.scratch().m_complianceScale;
    learnt = std::max(1.0, kForgetting * learnt);
    m_scale = learnt;
    m_dense = size() <= denseLimit;
    for (std::vector<Vec3>* vectors : {&m_impulse, &m_applied, &m_seen}) vectors->assign(m_ends.size(), Vec3());
    m_nodeIn.resize(nodes);
    m_nodeOut.resize(nodes);
    m_loadSpeed = speedByLoads(*m_body.m_body, step);
    m_formed = m_tooSoft = m_mixed = m_isPresent = false;
    m_firstJoint = std::min(m_firstJoint, size());
    m_firstPoint = m_dense ? 0 : m_firstJoint;
    m_points.clear(nodes);
    for (int e = m_firstPoint; e < size(); ++e)
        if (isGroup(m_ends[e]))
            m_points.addOwn();
        else
            m_points.add(m_ends[e].m_point);
    m_points.numberSlots();
    m_shares.reserve(m_points.slots());
    if (!m_dense)
    {
        m_velocity.assign(m_ends.size(), Vec3());
        m_before.assign(m_ends.size(), Vec3());
        return;
    }
    m_working.reset(m_points, m_body.m_body->m_model->mesh().componentCount());
    m_motions.assign(m_working.components(), RigidMotion());
    m_responses.reserve(m_points.slots());
    m_slotImpulse.assign(m_points.slots(), Vec3());
    m_own.resize(m_ends.size());
    m_slotVelocity.assign(m_points.order(), 0);
    m_slotBefore.assign(m_points.order(), 0);
}

void SoftBodyContacts::request(const Threads* threads)
{
    if (m_points.points() == 0) return;
    m_points.request(m_body, threads);
    if (m_body.m_compliance->forgets()) form();  // before the next body's request
}

void SoftBodyContacts::form()
{
    if (m_formed) return;
    m_formed = true;
    if (!m_dense) estimateDiagonal();
    if (m_points.points() == 0) return;
    findShares();
    m_points.form(m_body, m_scale, m_shares);
    int& present = m_body.m_body->m_workspace.scratch().m_presentSteps;
    if (present > 0 && mayBePresent())
        formPresent();
    else
        formGroups();
    if (present > 0) --present;
    if (m_dense) formOwn();
}

void SoftBodyContacts::formPresent()
{
    m_isPresent = true;
    completeWarpedSystem(*m_body.m_body, m_settings);
    const WarpedCompliance W(*m_body.m_body, 1);
    const std::vector<int>& nodes = m_points.nodes();
    for (std::size_t j = 0; j < 3 * nodes.size(); ++j)
    {
        std::fill(m_nodeIn.begin(), m_nodeIn.end(), Vec3());
        m_nodeIn[nodes[j / 3]][static_cast<int>(j % 3)] = 1;
        W.applyPresent(m_nodeIn, m_nodeOut);
        for (std::size_t t = j / 3; t < nodes.size(); ++t) m_points.setResponse(t, j, m_nodeOut[nodes[t]]);
    }
    formGroups();
}

void SoftBodyContacts::formGroups()
{
    for (int e = m_firstPoint; e < size(); ++e)
        if (isGroup(m_ends[e])) formGroup(e);
}

// The slots' shares in the rigid motion.
void SoftBodyContacts::findShares()
{
    const RigidMomentum& momentum = m_body.m_body->m_workspace.scratch().m_momentum;
    const Mat3 whole = Mat3::identity();
    m_shares.clear();
    for (int node : m_points.nodes()) m_shares.push_back(momentum.shareOf(*m_body.m_body, &node, &whole, 1));
    for (int e = m_firstPoint; e < size(); ++e)
        if (isGroup(m_ends[e]))
            m_shares.push_back(
                momentum.shareOf(*m_body.m_body, m_ends[e].m_nodes, m_ends[e].m_blocks, m_ends[e].m_count));
}

void SoftBodyContacts::formOwn()
{
    for (int e = 0; e < size(); ++e) m_own[e] = m_points.block(e, e);
}

// Couplings between a group of nodes, the nodes of the points, and the groups from it on.
void SoftBodyContacts::formGroup(int e)
{
    const WarpedCompliance P(*m_body.m_body, m_scale);
    const std::vector<int>& nodes = m_points.nodes();
    const std::size_t own = 3 * static_cast<std::size_t>(m_points.slot(e - m_firstPoint));
    for (std::size_t j = own; j < own + 3; ++j)
    {
        Vec3 unit;
        unit[static_cast<int>(j - own)] = 1;
        std::fill(m_nodeIn.begin(), m_nodeIn.end(), Vec3());
        scatter(m_ends[e], unit, m_nodeIn);
        if (m_isPresent)
            P.applyPresent(m_nodeIn, m_nodeOut);
        else
            P.applyElastic(m_nodeIn, m_nodeOut);
        for (std::size_t t = 0; t < nodes.size(); ++t) m_points.setResponse(t, j, m_nodeOut[nodes[t]]);
        for (int f = e; f < size(); ++f)
            if (isGroup(m_ends[f]))
                m_points.setResponse(m_points.slot(f - m_firstPoint), j, read(m_ends[f], m_nodeOut));
    }
}

// Mean of some blocks W_ee, without rotation to world axes, which serves only to scale contact rows. All sides get a
// unit impulse at once, with random signs that cancel their couplings [Hutchinson 1990].
void SoftBodyContacts::estimateDiagonal()
{
    const int samples = std::min(size(), kSamples);
    const auto endOf = [&](int k) -> const End&
    { return m_ends[static_cast<std::size_t>(k) * m_ends.size() / samples]; };
    const auto sign = [](int bits) { return bits % 2 == 0 ? 1.0 : -1.0; };
    const auto signs = [&sign](int k) -> Vec3 { return {sign(k), sign(k >> 1), sign(k ^ (k >> 2))}; };
    std::fill(m_nodeIn.begin(), m_nodeIn.end(), Vec3());
    for (int k = 0; k < samples; ++k) scatter(endOf(k), signs(k), m_nodeIn);
    WarpedCompliance(*m_body.m_body, m_scale).apply(m_nodeIn, m_nodeOut);
    double sum = 0;
    for (int k = 0; k < samples; ++k) sum += dot(signs(k), read(endOf(k), m_nodeOut)) / 3;
    m_meanDiagonal = Mat3::diagonal(sum / samples);
}

Mat3 SoftBodyContacts::compliance(int e, int f) const
{
    if (m_dense && e == f) return m_own[e];
    if (std::min(e, f) >= m_firstPoint) return m_points.block(e - m_firstPoint, f - m_firstPoint);
    return e == f ? m_meanDiagonal : Mat3();
}

double SoftBodyContacts::elasticCompliance(int e) const
{
    const Mat3 elastic = m_own[e] - m_points.rigid(e).block(m_points.rigid(e));
    return (elastic(0, 0) + elastic(1, 1) + elastic(2, 2)) / 3;
}

bool SoftBodyContacts::serves(int node) const
{
    const std::vector<int>& surface = m_body.m_body->m_model->mesh().surfaceNodes();
    return m_body.m_compliance->serves(node) && std::binary_search(surface.begin(), surface.end(), node);
}

int SoftBodyContacts::nodeOf(int e) const
{
    const SurfacePoint& point = m_ends[e].m_point;
    if (isGroup(m_ends[e]) || e < m_firstPoint || point.m_count != 1 || point.m_weights[0] != 1) return -1;
    const int node = point.m_nodes[0];
    const bool moves = !m_body.m_body->m_state.m_fixed[node] && m_body.m_body->m_model->factor().position(node) >= 0;
    return moves ? node : -1;
}

Mat3 SoftBodyContacts::rotation(int node) const
{
    return WarpedPreconditioner(*m_body.m_body).rotation(node);
}

Vec3 SoftBodyContacts::trueVelocity(int e) const
{
    return read(m_ends[e], bullet_fem::velocity(*m_body.m_body));
}

Vec3 SoftBodyContacts::arc(int e) const
{
    return m_theta < 1 ? Vec3() : m_step * read(m_ends[e], m_body.m_body->m_workspace.scratch().m_drift);
}

Vec3 SoftBodyContacts::meanVelocity(int e) const
{
    return read(m_ends[e], m_body.m_body->m_workspace.scratch().m_drift) + m_theta * velocity(e);
}

void SoftBodyContacts::push(int e, const Vec3& impulse)
{
    m_impulse[e] += impulse;
    if (!m_dense) return;
    if (m_working.has(e))
        m_working.push(e, impulse);
    else
        m_pushedAtRest = true;
}

void SoftBodyContacts::refresh()
{
    if (!m_dense) return;
    if (m_pushedAtRest)
        for (int e = 0; e < size(); ++e) see(e);
    else
        for (int e : m_working.ends()) see(e);
    m_responses.clear();
    for (int slot = 0; slot < m_points.slots(); ++slot)
    {
        Vec3& impulse = m_slotImpulse[slot];
        if (dot(impulse, impulse) > 0) m_responses.push_back(m_points.response(slot, impulse));
        impulse = {};
    }
    if (m_responses.empty() && !m_pushedAtRest) return;
    addResponses(m_responses.data(), m_responses.size(), m_points.order(), m_slotVelocity.data());
    m_points.addRigid(m_motions, m_slotVelocity);
    std::fill(m_motions.begin(), m_motions.end(), RigidMotion());
    if (m_pushedAtRest) m_working.load(m_slotVelocity);
    m_pushedAtRest = false;
}

void SoftBodyContacts::see(int e)
{
    const Vec3 unseen = m_impulse[e] - m_seen[e];
    if (dot(unseen, unseen) > 0)
    {
        m_points.forEachSlot(e, [&](int slot, double weight) { m_slotImpulse[slot] += weight * unseen; });
        const RigidSide& rigid = m_points.rigid(e);
        if (rigid.component() >= 0) m_motions[rigid.component()] += rigid.response(unseen);
    }
    m_seen[e] = m_impulse[e];
}

void SoftBodyContacts::flush()
{
    if (m_dense) return refresh();
    if (m_ends.empty() || !gatherBeyond(m_seen)) return;
    m_seen.assign(m_impulse.begin(), m_impulse.end());
    WarpedCompliance(*m_body.m_body, m_scale).apply(m_nodeIn, m_nodeOut);
    for (int e = 0; e < size(); ++e) m_velocity[e] += read(m_ends[e], m_nodeOut);
}

void SoftBodyContacts::measure()
{
    m_seen.assign(m_applied.begin(), m_applied.end());
    if (m_dense)
    {
        measureSlots();
        m_pushedAtRest = true;  // the working set must get the true velocities
    }
    else
        for (int e = 0; e < size(); ++e) m_velocity[e] = m_before[e] = trueVelocity(e);
    flush();
}

void SoftBodyContacts::measureSlots()
{
    const auto put = [this](int slot, const Vec3& v)
    {
        for (int i = 0; i < 3; ++i) m_slotVelocity[3 * static_cast<std::size_t>(slot) + i] = v[i];
    };
    const std::vector<Vec3>& v = bullet_fem::velocity(*m_body.m_body);
    int slot = 0;
    for (int node : m_points.nodes()) put(slot++, v[node]);
    for (int e = 0; slot < m_points.slots(); ++e)
        if (isGroup(m_ends[e])) put(slot++, trueVelocity(e));
    m_slotBefore.assign(m_slotVelocity.begin(), m_slotVelocity.end());
}

// Distributes the unapplied impulses to the nodes; false if there are none.
bool SoftBodyContacts::gatherBeyond(const std::vector<Vec3>& known)
{
    bool any = false;
    std::fill(m_nodeIn.begin(), m_nodeIn.end(), Vec3());
    for (int e = 0; e < size(); ++e)
    {
        const Vec3 impulse = m_impulse[e] - known[e];
        if (dot(impulse, impulse) == 0) continue;
        any = true;
        scatter(m_ends[e], impulse, m_nodeIn);
    }
    return any;
}

void SoftBodyContacts::beginPush()
{
    for (std::vector<Vec3>* vectors : {&m_velocity, &m_impulse, &m_applied, &m_seen})
        std::fill(vectors->begin(), vectors->end(), Vec3());
    std::fill(m_slotVelocity.begin(), m_slotVelocity.end(), 0.0);
    if (m_dense && size() > 0) m_working.load(m_slotVelocity);
}

Vec3 SoftBodyContacts::applyPositionCorrection(const StepSettings& settings)
{
    return gatherBeyond(m_applied) ? bullet_fem::applyPositionCorrection(*m_body.m_body, m_nodeIn, settings) : Vec3();
}

void SoftBodyContacts::spin(const Vec3& angularImpulse, const StepSettings& settings)
{
    if (dot(angularImpulse, angularImpulse) == 0) return;
    StepScratch& scratch = m_body.m_body->m_workspace.scratch();
    const int node = isGroup(m_ends[0]) ? m_ends[0].m_nodes[0] : m_ends[0].m_point.m_nodes[0];
    scratch.m_momentum.addAngularImpulse(*m_body.m_body, node, angularImpulse, settings.m_step);
    scratch.m_momentum.restore(*m_body.m_body, scratch.m_velocity);
}

}  // namespace bullet_fem
