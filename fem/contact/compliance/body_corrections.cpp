// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Corrective solves of a body, and the update of its compliance by their results.
#include <algorithm>
#include <cmath>

#include "fem/body/step_scratch.h"
#include "fem/contact/compliance/soft_body_contacts.h"
#include "fem/contact/contact_tuning.h"

namespace bullet_fem
{
namespace
{

// Share of the work of all impulses, or of that of every new impulse alone, below which an outer iteration gives no
// information: impulses that press a stiff body from all sides cancel each other up to the rounding of W.
constexpr double kNoise = 1e-4;
constexpr double kRounding = 1e-9;  // share of the body's speed below which changes of velocity give no information

}  // namespace

ImpulseResponse SoftBodyContacts::beginCorrection(const StepSettings& settings, double floor)
{
    m_learnt = false;
    refresh();
    if (!gatherBeyond(m_applied) && !m_mixed) return {};
    addLevers(settings);
    return {m_body.m_body, &m_nodeIn, settings, normOfFloor(floor), false, {}};
}

// Norm of a residual [N s].
double SoftBodyContacts::normOfFloor(double floor) const
{
    double all = 0;
    for (const Vec3& impulse : m_impulse) all += dot(impulse, impulse);
    return floor * std::sqrt(all);
}

// Two surfaces separated by a gap share one point of action: the moment by the gap's lever is applied as a spin. An
// equal correction applies to groups of nodes whose impulse acts at their positions at the beginning of the step.
void SoftBodyContacts::addLevers(const StepSettings& settings)
{
    RigidMomentum& momentum = m_body.m_body->m_workspace.scratch().m_momentum;
    for (int e = 0; e < size(); ++e)
    {
        const End& end = m_ends[e];
        const Vec3 added = m_impulse[e] - m_applied[e];
        if (!isGroup(end))
            momentum.addAngularImpulse(*m_body.m_body, end.m_point.m_nodes[0], cross(end.m_offset, added),
                                       settings.m_step);
        else if (end.m_actsAtStart && m_theta < 1)
            momentum.addAngularImpulse(*m_body.m_body, end.m_nodes[0], groupLever(end, added), settings.m_step);
    }
}

Vec3 SoftBodyContacts::groupLever(const End& end, const Vec3& impulse) const
{
    const std::vector<Vec3>& begin = m_body.m_body->m_state.m_x;
    const std::vector<Vec3>& kick = m_body.m_body->m_workspace.scratch().m_kickPosition;
    Vec3 lever;
    for (int i = 0; i < end.m_count; ++i)
        lever += cross(begin[end.m_nodes[i]] - kick[end.m_nodes[i]], transpose(end.m_blocks[i]) * impulse);
    return lever;
}

void SoftBodyContacts::takeExpected(const StepSettings& settings, double floor)
{
    if (m_ends.empty()) return giveUpExpected(settings);
    addLevers(settings);
    gatherBeyond(m_applied);
    Body& body = *m_body.m_body;
    StepScratch& scratch = body.m_workspace.scratch();
    if (!scratch.m_hasResidual) std::fill(scratch.m_residual.begin(), scratch.m_residual.end(), Vec3());
    scratch.m_hasResidual = true;
    double left = 0;
    for (std::size_t i = 0; i < m_nodeIn.size(); ++i)
    {
        m_nodeIn[i] = body.m_state.m_fixed[i] ? Vec3() : m_nodeIn[i] - (*m_body.m_predicted)[i];
        scratch.m_residual[i] += m_nodeIn[i];
        scratch.m_impulses[i] += m_nodeIn[i];
        left += dot(scratch.m_residual[i], scratch.m_residual[i]);
    }
    scratch.m_momentum.addImpulses(body, m_nodeIn, settings.m_step);
    scratch.m_momentum.restore(body, scratch.m_velocity);
    m_mixed = std::sqrt(left) > settings.m_tolerance * normOfFloor(floor);
    m_applied.assign(m_impulse.begin(), m_impulse.end());
}

void SoftBodyContacts::giveUpExpected(const StepSettings& settings)
{
    const std::vector<Vec3>& expected = *m_body.m_predicted;
    m_nodeIn.assign(expected.begin(), expected.end());
    for (Vec3& impulse : m_nodeIn) impulse *= -1;
    applyImpulses(*m_body.m_body, m_nodeIn, settings);
}

void SoftBodyContacts::endCorrection()
{
    double trueWork = 0, predictedWork = 0;  // work of the new impulses on their velocity changes
    double aloneWork = 0;                    // predicted work of every new impulse alone
    double impulses = 0;                     // sum of the new impulses [N s]
    m_allWork = 0;                           // approximate work of all impulses
    const bool isJudged = mayBePresent();
    const double ofRigid = isJudged ? rigidWork() : 0;
    for (int e = 0; e < size(); ++e)
    {
        const Vec3 impulse = m_impulse[e] - m_applied[e];
        m_applied[e] = m_impulse[e];
        if (dot(m_impulse[e], m_impulse[e]) > 0) m_allWork += dot(m_impulse[e], compliance(e, e) * m_impulse[e]);
        if (!(dot(impulse, impulse) > 0)) continue;
        impulses += norm(impulse);
        aloneWork += dot(impulse, compliance(e, e) * impulse);
        trueWork += dot(impulse, trueVelocity(e) - before(e));
        predictedWork += dot(impulse, known(e) - before(e));
    }
    const bool isNews = !m_mixed && predictedWork > kNoise * std::max(m_allWork, aloneWork);
    m_mixed = false;
    const Lesson lesson = {trueWork, predictedWork, impulses};
    if (!isNews || !hasContacts()) return;
    if (isJudged)
        judge(lesson, ofRigid);
    else
        learn(lesson);
}

// Only joints and contacts on one body are known to need it.
bool SoftBodyContacts::mayBePresent() const
{
    const std::size_t work = static_cast<std::size_t>(m_points.slots()) * m_body.m_body->m_model->mesh().tets().size();
    return m_dense && hasContacts() && m_firstJoint < size() && work <= kMaxPresentWork;
}

// Work of the new impulses on the rigid velocities by them, for a dense body.
double SoftBodyContacts::rigidWork()
{
    const auto forEachNew = [this](const auto& visit)
    {
        for (int e = 0; e < size(); ++e)
            if (const RigidSide& rigid = m_points.rigid(e); rigid.component() >= 0)
                visit(rigid, m_impulse[e] - m_applied[e], m_motions[rigid.component()]);
    };
    double work = 0;
    forEachNew([](const RigidSide& rigid, const Vec3& impulse, RigidMotion& motion)
               { motion += rigid.response(impulse); });
    forEachNew([&work](const RigidSide& rigid, const Vec3& impulse, const RigidMotion& motion)
               { work += dot(impulse, rigid.velocity(motion)); });
    std::fill(m_motions.begin(), m_motions.end(), RigidMotion());
    return work;
}

// Both sides share the point of action of an impulse, so that momenta are conserved: for points that of the contact,
// for groups the nodes' own (addGroup).
void SoftBodyContacts::noteReactions()
{
    StepScratch& scratch = m_body.m_body->m_workspace.scratch();
    SupportReactions& reactions = scratch.m_reactions;
    if (!reactions.isNoting()) return;
    const std::vector<int>& componentOf = m_body.m_body->m_model->mesh().nodeComponent();
    std::fill(m_nodeIn.begin(), m_nodeIn.end(), Vec3());
    for (int e = 0; e < size(); ++e)
    {
        const End& end = m_ends[e];
        const Vec3& impulse = m_applied[e];
        if (dot(impulse, impulse) == 0) continue;
        scatter(end, impulse, m_nodeIn);
        if (!isGroup(end))
        {
            const Vec3 at = read(end, scratch.m_kickPosition) + end.m_offset;
            reactions.addOutside(componentOf[end.m_point.m_nodes[0]], impulse, cross(at, impulse));
            continue;
        }
        const std::vector<Vec3>& at = end.m_actsAtStart ? m_body.m_body->m_state.m_x : scratch.m_kickPosition;
        for (int i = 0; i < end.m_count; ++i)
        {
            const Vec3 part = transposeTimes(end.m_blocks[i], impulse);
            const int node = end.m_nodes[i];
            reactions.addOutside(componentOf[node], part, cross(at[node], part));
        }
    }
    reactions.add(m_nodeIn);
}

// True if the velocity changes by the new impulses exceed the rounding of the body's velocities. At rest these are
// small: then the velocity that was just stopped counts.
bool SoftBodyContacts::isAboveRounding(const Lesson& lesson) const
{
    double fastest = m_loadSpeed;
    for (const Vec3& v : bullet_fem::velocity(*m_body.m_body)) fastest = std::max(fastest, norm(v));
    return lesson.m_predictedWork > kRounding * fastest * lesson.m_impulses;
}

void SoftBodyContacts::learn(const Lesson& lesson)
{
    const bool softer = kMaxMisfit * lesson.m_trueWork < lesson.m_predictedWork;
    const bool stiffer = lesson.m_trueWork > kMaxMisfit * lesson.m_predictedWork;
    if (!(softer || stiffer) || !isAboveRounding(lesson)) return;
    m_tooSoft = m_tooSoft || softer;
    if (!stiffer) return;
    const double factor = kScaleMargin * lesson.m_trueWork / lesson.m_predictedWork;
    m_learnt = true;
    m_scale *= factor;
    m_body.m_body->m_workspace.scratch().m_complianceScale = m_scale;
    if (m_points.points() > 0) m_points.scaleElastic(factor);
    if (m_dense) followCompliance();
}

// No scale mends W in directions in which it is too stiff and too soft.
void SoftBodyContacts::judge(const Lesson& lesson, double rigidWork)
{
    const double ofTrue = lesson.m_trueWork - rigidWork, ofW = lesson.m_predictedWork - rigidWork;
    const bool isFit = kMaxMisfit * ofTrue > ofW && ofTrue < kMaxMisfit * ofW;
    if (isFit || !isAboveRounding(lesson)) return;
    m_tooSoft = m_tooSoft || !(kMaxMisfit * ofTrue > ofW);
    m_body.m_body->m_workspace.scratch().m_presentSteps = kPresentSteps;
    if (m_isPresent) return;
    formPresent();
    m_learnt = true;
    followCompliance();
}

void SoftBodyContacts::followCompliance()
{
    formOwn();
    m_working.reset(m_points, static_cast<int>(m_motions.size()));
}

}  // namespace bullet_fem
