// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Distributes the solution of a group's contacts and joints to its bodies.
#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/common/threads.h"
#include "plugin/joints/btFemAttachments.h"
#include "plugin/stages/btFemContactGroup.h"

using namespace bullet_fem;

namespace
{

constexpr int kUsualRebounds = 4;  // of a body in a step: room for contact points of their own

// Fills in the impulse on one side, and that side's point.
void fill(btFemContact& contact, const ContactPoint& point, bool otherSide)
{
    const SurfacePoint& side = otherSide ? point.m_other : point.m_soft;
    const Vec3 normal = otherSide ? -point.m_normal : point.m_normal;
    const Vec3 impulse = otherSide ? -point.m_impulse : point.m_impulse;
    contact.m_point = bulletVector(point.m_point);
    contact.m_normal = bulletVector(normal);
    contact.m_gap = static_cast<btScalar>(point.m_gap);
    contact.m_impulse = bulletVector(impulse);
    contact.m_normalImpulse = static_cast<btScalar>(dot(impulse, normal));
    contact.m_frictionImpulse = bulletVector(impulse - dot(impulse, normal) * normal);
    static_assert(btFemContact::kMaxNodes == SurfacePoint::kMaxNodes);
    contact.m_nodeCount = side.m_count;
    for (int a = 0; a < side.m_count; ++a)
    {
        contact.m_nodes[a] = side.m_nodes[a];
        contact.m_weights[a] = static_cast<btScalar>(side.m_weights[a]);
    }
}

void noteContact(btFemBodyReports& reports, const btFemContact& contact, const ContactPoint& point)
{
    reports.m_contacts.push_back(contact);
    btScalar& deepest = reports.m_step.m_deepestPenetration;
    deepest = std::max(deepest, static_cast<btScalar>(-point.m_gap));
}

void addImpulse(btFemContact& contact, const btVector3& impulse)
{
    contact.m_impulse += impulse;
    contact.m_normalImpulse = std::max(contact.m_impulse.dot(contact.m_normal), btScalar(0));
    contact.m_frictionImpulse = contact.m_impulse - contact.m_normalImpulse * contact.m_normal;
}

// One side of a rebound.
struct ReboundSide
{
    const btCollisionObject* m_other;
    int m_otherId, m_component;
    Vec3 m_point, m_normal, m_impulse;  // on this side
};

// A contact point at the node that is nearest to the rebound.
btFemContact contactOf(const btFemBodyRecord& record, const ReboundSide& side)
{
    const Body& body = record.fem().m_body;
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    const std::vector<Vec3>& x = body.m_state.m_x;
    int nearest = -1;
    double least = 0;
    for (int i = 0; i < static_cast<int>(x.size()); ++i)
    {
        const Vec3 off = x[i] - side.m_point;
        if (componentOf[i] != side.m_component || (nearest >= 0 && !(dot(off, off) < least))) continue;
        nearest = i;
        least = dot(off, off);
    }
    btFemContact contact;
    contact.m_point = bulletVector(side.m_point);
    contact.m_normal = bulletVector(side.m_normal);
    contact.m_impulse = contact.m_frictionImpulse = btVector3(0, 0, 0);
    contact.m_other = side.m_other;
    contact.m_weights[0] = 1;
    for (int a = 0; a < contact.m_nodeCount; ++a) contact.m_nodes[a] = nearest;
    return contact;
}

// Shares the impulse out to the contact points of the two, in proportion to their normal impulses, or evenly.
void noteRebound(btFemBodyRecord& record, const ReboundSide& side)
{
    btAlignedObjectArray<btFemContact>& contacts = record.m_reports.m_contacts;
    const std::vector<int>& componentOf = record.fem().m_body.m_model->mesh().nodeComponent();
    const auto isOf = [&](const btFemContact& contact)
    { return contact.m_other == side.m_other && componentOf[contact.m_nodes[0]] == side.m_component; };
    btScalar push = 0;
    int count = 0;
    for (int k = 0; k < contacts.size(); ++k)
    {
        if (!isOf(contacts[k])) continue;
        push += contacts[k].m_normalImpulse;
        ++count;
    }
    if (count == 0)
    {
        contacts.push_back(contactOf(record, side));
        record.m_reports.m_step.m_contacts = contacts.size();
        count = 1;
    }
    const btVector3 impulse = bulletVector(side.m_impulse);
    for (int k = 0; k < contacts.size(); ++k)
        if (isOf(contacts[k]))
            addImpulse(contacts[k], (push > 0 ? contacts[k].m_normalImpulse / push : 1 / btScalar(count)) * impulse);
    addTouchImpulse(record, side.m_other, side.m_otherId, impulse,
                    static_cast<btScalar>(dot(side.m_impulse, side.m_normal)));
}

}  // namespace

void btFemContactGroup::report(const ContactReport& report)
{
    makeRoomForReports();
    m_together.clear();
    for (const btFemBodyRecord* record : m_records) m_together.emplace_back(record->m_softBody, record);
    std::sort(m_together.begin(), m_together.end());
    m_touchesBegin.assign(m_records.size(), 0);
    m_settings.m_step.m_threads->run(static_cast<int>(m_records.size()),
                                     [&](int b)
                                     {
                                         reportBody(b, report);
                                         m_touchesBegin[b] = !updateKnownTouches(*m_records[b], m_together);
                                     });
    m_softPairs.remember(m_problem.m_contacts.data() + m_firstRigid.back());
    for (std::size_t b = 0; b < m_records.size(); ++b)
    {
        if (m_touchesBegin[b]) updateTouches(*m_records[b], m_together);
        SoftJoints::takeBack(*m_bodies[b], m_problem);
        writeReports(*m_bodies[b], m_records[b]->m_reports.m_anchors);
    }
    m_welds.breakWelds(m_bodies, m_step);
}

// On one thread: Bullet's allocator may not be thread-safe.
void btFemContactGroup::makeRoomForReports()
{
    const auto visitSides = [this](const auto& visit)
    {
        for (std::size_t k = m_firstRigid.back(); k < m_cloth.first(); ++k)
        {
            const int a = m_problem.m_contacts[k].m_soft.m_body, b = m_problem.m_contacts[k].m_other.m_body;
            visit(a, k);
            if (b != a) visit(b, k);
        }
    };
    std::vector<std::size_t>& first = m_firstSoft;
    first.assign(m_records.size() + 2, 0);  // shifted by one while the array is filled
    visitSides([&first](int b, std::size_t) { ++first[b + 2]; });
    for (std::size_t b = 2; b < first.size(); ++b) first[b] += first[b - 1];
    m_softContacts.resize(first.back());
    visitSides([&](int b, std::size_t k) { m_softContacts[first[b + 1]++] = k; });
    first.pop_back();
    for (std::size_t b = 0; b < m_records.size(); ++b)
    {
        btAlignedObjectArray<btFemContact>& reported = m_records[b]->m_reports.m_contacts;
        const int count = static_cast<int>(m_firstRigid[b + 1] - m_firstRigid[b] + first[b + 1] - first[b]) +
                          m_cloth.countOf(b) + kUsualRebounds;
        if (count > reported.capacity()) reported.reserve(std::max(count, 2 * reported.capacity()));
    }
}

void btFemContactGroup::reportBody(std::size_t b, const ContactReport& report)
{
    btFemBodyRecord& record = *m_records[b];
    ContactMemory& memory = record.fem().m_memory;
    std::copy_n(m_problem.m_contacts.begin() + static_cast<std::ptrdiff_t>(m_firstRigid[b]), memory.m_contacts.size(),
                memory.m_contacts.begin());
    record.m_reports.m_contacts.resize(0);
    record.m_reports.m_step.m_contactMs = static_cast<btScalar>(m_milliseconds);
    record.m_reports.m_step.m_contactSweeps = report.m_sweeps;
    record.m_reports.m_step.m_contactIterations = report.m_iterations;
    record.m_reports.m_step.m_contactViolation = static_cast<btScalar>(report.m_violation);
    record.m_reports.m_step.m_deepestPenetration = 0;
    record.m_reports.m_step.m_impactStress = static_cast<btScalar>(m_rebounds.impactStressOf(b));
    if (!report.m_converged) record.m_reports.m_step.m_flags |= BT_FEM_NOT_CONVERGED;
    for (std::size_t k = 0; k < memory.m_contacts.size(); ++k)
    {
        btFemContact contact;
        fill(contact, memory.m_contacts[k], false);
        contact.m_other = memory.m_origins[k].m_object;
        contact.m_part = memory.m_origins[k].m_part;
        contact.m_index = memory.m_origins[k].m_triangle;
        noteContact(record.m_reports, contact, memory.m_contacts[k]);
    }
    // Both bodies report a contact between them, each from its side; self contact is reported once.
    for (std::size_t k = m_firstSoft[b]; k < m_firstSoft[b + 1]; ++k)
    {
        const ContactPoint& point = m_problem.m_contacts[m_softContacts[k]];
        const bool otherSide = point.m_soft.m_body != static_cast<int>(b);
        btFemContact contact;
        fill(contact, point, otherSide);
        contact.m_other = m_records[otherSide ? point.m_soft.m_body : point.m_other.m_body]->m_softBody;
        noteContact(record.m_reports, contact, point);
    }
    reportCloth(b);
    record.m_reports.m_step.m_contacts = record.m_reports.m_contacts.size();
    record.m_reports.m_step.m_flags |= stateFlags(record) & BT_FEM_PENETRATING;
}

// Reports contact points on the body's surface, as for rigid objects.
void btFemContactGroup::reportCloth(std::size_t b)
{
    for (std::size_t k = 0; k < m_cloth.size(); ++k)
    {
        const ContactPoint& point = m_problem.m_contacts[m_cloth.first() + k];
        if (point.m_soft.m_body != static_cast<int>(b)) continue;
        btFemContact contact;
        fill(contact, point, false);
        contact.m_point = bulletVector(m_cloth.onBody(k));
        contact.m_other = &m_cloth.cloth(k);
        noteContact(m_records[b]->m_reports, contact, point);
    }
}

void btFemContactGroup::reportRebound(const GivenRebound& given, const std::vector<btFemBodyRecord*>& records)
{
    const Impact& impact = given.m_impact;
    const auto recordOf = [&records](const FemSoftBody* fem)
    { return *std::find_if(records.begin(), records.end(), [fem](const auto* r) { return &r->fem() == fem; }); };
    if (given.m_body)
        noteRebound(*recordOf(given.m_body), {impact.m_other, impact.m_otherId, impact.m_component, impact.m_point,
                                              impact.m_normal, given.m_impulse});
    if (given.m_otherBody)
        noteRebound(*recordOf(given.m_otherBody),
                    {given.m_object, broadphaseId(*given.m_object), impact.m_otherComponent, impact.m_point,
                     -impact.m_normal, -given.m_impulse});
}
