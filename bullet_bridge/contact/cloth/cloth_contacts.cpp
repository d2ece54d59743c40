// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/cloth/cloth_contacts.h"

#include <algorithm>
#include <tuple>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/contact/friction.h"
#include "bullet_bridge/contact/nearest_contacts.h"
#include "bullet_bridge/geometry/tolerances.h"
#include "bullet_bridge/joints/rigid_pivot.h"
#include "bullet_bridge/joints/soft_anchors.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_fem/fem/common/threads.h"

namespace bullet_fem
{
namespace
{

constexpr double kErp = 0.5;  // share of an attachment's error that a step corrects (Baumgarte) [-]

}  // namespace

bool ClothContacts::NodeUse::operator<(const NodeUse& b) const
{
    return std::tie(m_surface, m_node, m_hold) < std::tie(b.m_surface, b.m_node, b.m_hold);
}

void ClothContacts::note(FemSoftBody& fem, btSoftBody& cloth, bool touches)
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    const auto isNoted = [&](const Pair& pair) { return pair.m_fem == &fem && pair.m_cloth == &cloth; };
    if (std::none_of(m_pairs.begin(), m_pairs.end(), isNoted))
        m_pairs.push_back({&fem, &cloth, broadphaseId(cloth), touches});
}

void ClothContacts::noteAttached(FemSoftBody& fem, const btAlignedObjectArray<btSoftBody*>& bodies)
{
    std::vector<ClothAttachment>& attachments = fem.m_joints.m_clothAttachments;
    const auto isGone = [&](ClothAttachment& a)
    {
        if (bodies.findLinearSearch(a.m_cloth) >= bodies.size()) return true;
        if (a.m_clothId < 0) a.m_clothId = broadphaseId(*a.m_cloth);
        return broadphaseId(*a.m_cloth) != a.m_clothId || a.m_clothNode >= a.m_cloth->m_nodes.size();
    };
    const auto gone = std::remove_if(attachments.begin(), attachments.end(), isGone);
    fem.m_joints.m_clothIsLost = fem.m_joints.m_clothIsLost || gone != attachments.end();
    attachments.erase(gone, attachments.end());
    for (const ClothAttachment& a : attachments) note(fem, *a.m_cloth, false);
}

void ClothContacts::beginStep()
{
    m_pairs.clear();
    m_solved.clear();
}

void ClothContacts::keepOnly(const btAlignedObjectArray<btSoftBody*>& bodies)
{
    const auto isGone = [&](const btSoftBody* cloth, int id)  // dangling pointers are compared, never followed
    { return bodies.findLinearSearch(const_cast<btSoftBody*>(cloth)) >= bodies.size() || broadphaseId(*cloth) != id; };
    m_pairs.erase(std::remove_if(m_pairs.begin(), m_pairs.end(),
                                 [&](const Pair& pair) { return isGone(pair.m_cloth, pair.m_clothId); }),
                  m_pairs.end());
    m_surfaces.erase(std::remove_if(m_surfaces.begin(), m_surfaces.end(),
                                    [&](const std::unique_ptr<ClothSurface>& surface)
                                    { return isGone(&surface->body(), surface->id()); }),
                     m_surfaces.end());
}

void ClothContacts::solveSprings(btSoftBody& cloth)
{
    const auto isOfPair = [&](const Pair& pair) { return pair.m_cloth == &cloth; };
    if (areSpringsSolved(cloth) || std::none_of(m_pairs.begin(), m_pairs.end(), isOfPair)) return;
    cloth.solveConstraints();
    m_solved.push_back(&cloth);
}

void ClothContacts::finishSprings(btSoftBody& cloth)
{
    if (!areSpringsSolved(cloth)) cloth.solveConstraints();
}

bool ClothContacts::areSpringsSolved(const btSoftBody& cloth) const
{
    return std::find(m_solved.begin(), m_solved.end(), &cloth) != m_solved.end();
}

// Cloth of earlier steps that is in no pair now may be deleted: its pointer is compared, never followed.
int ClothContacts::surfaceOf(const Pair& pair)
{
    for (std::size_t k = 0; k < m_surfaces.size(); ++k)
        if (&m_surfaces[k]->body() == pair.m_cloth && m_surfaces[k]->id() == pair.m_clothId) return static_cast<int>(k);
    m_surfaces.push_back(std::make_unique<ClothSurface>(*pair.m_cloth));
    return static_cast<int>(m_surfaces.size()) - 1;
}

// Sorts by body, then by the cloth's broadphase id: the order depends neither on addresses nor on threads.
void ClothContacts::listSearches(const std::vector<FemSoftBody*>& bodies)
{
    std::sort(m_pairs.begin(), m_pairs.end(), [](const Pair& a, const Pair& b) { return a.m_clothId < b.m_clothId; });
    m_searchCount = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b)
        for (const Pair& pair : m_pairs)
        {
            if (pair.m_fem != bodies[b]) continue;
            if (m_searchCount == m_searches.size()) m_searches.push_back(std::make_unique<Search>());
            Search& search = *m_searches[m_searchCount++];
            search.m_body = static_cast<int>(b);
            search.m_surface = surfaceOf(pair);
            search.m_mayTouch = pair.m_mayTouch;
            search.m_limited = false;
            search.m_touches.clear();
        }
    m_isUsed.assign(m_surfaces.size(), 0);
    for (std::size_t k = 0; k < m_searchCount; ++k) m_isUsed[m_searches[k]->m_surface] = 1;
}

void ClothContacts::find(const std::vector<FemSoftBody*>& bodies, double step, int maxContacts, const Threads& threads)
{
    m_bodies = &bodies;
    m_searchCount = 0;
    m_holds.clear();
    m_contactCount = 0;
    if (m_pairs.empty()) return;
    listSearches(bodies);
    m_isUsable.assign(m_surfaces.size(), 0);
    threads.run(static_cast<int>(m_surfaces.size()),
                [&](int k) { m_isUsable[k] = m_isUsed[k] && m_surfaces[k]->update(step) ? 1 : 0; });
    for (std::size_t k = 0; k < m_searchCount; ++k)
    {
        FemSoftBody& fem = *bodies[m_searches[k]->m_body];
        if (k > 0 && m_searches[k - 1]->m_body == m_searches[k]->m_body) continue;
        fem.updateSkin();
        fem.m_surface.place(fem.surfacePosition(), fem.surfaceVelocity(), step);
        fem.m_surface.prepareAll();
    }
    threads.run(static_cast<int>(m_searchCount),
                [&](int k) { search(*bodies[m_searches[k]->m_body], maxContacts, *m_searches[k]); });
}

void ClothContacts::search(const FemSoftBody& fem, int maxContacts, Search& search) const
{
    if (!m_isUsable[search.m_surface]) return;
    const ClothSurface& cloth = *m_surfaces[search.m_surface];
    const double thickness = cloth.thickness() + fem.m_settings.m_contactOffset;
    ClothContactSearch(fem.m_surface, cloth, thickness, kContactBand * fem.m_surface.meanEdge()).find(search.m_touches);
    search.m_limited = keepNearest(maxContacts, search.m_order, search.m_touches);
}

bool ClothContacts::isLimited(std::size_t b) const
{
    const auto isOf = [b](const std::unique_ptr<Search>& search)
    { return search->m_limited && search->m_body == static_cast<int>(b); };
    return std::any_of(m_searches.begin(), m_searches.begin() + static_cast<std::ptrdiff_t>(m_searchCount), isOf);
}

int ClothContacts::countOf(std::size_t b) const
{
    std::size_t count = 0;
    for (std::size_t k = 0; k < m_searchCount; ++k)
        if (m_searches[k]->m_body == static_cast<int>(b)) count += m_searches[k]->m_touches.size();
    return static_cast<int>(count);
}

void ClothContacts::append(double step, ContactProblem& problem)
{
    m_firstContact = problem.m_contacts.size();
    m_firstProxy = problem.m_rigidProxies.size();
    for (std::size_t k = 0; k < m_searchCount; ++k)
        for (const ClothContact& touch : m_searches[k]->m_touches)
            appendContact(*m_searches[k], *(*m_bodies)[m_searches[k]->m_body], touch, problem);
    m_contactCount = m_holds.size();
    for (std::size_t k = 0; k < m_searchCount; ++k) appendJoints(*m_searches[k], step, problem);
    if (m_holds.empty()) return;
    listUses();
    connect(problem);
}

int ClothContacts::appendProxy(const Hold& hold, const Vec3& at, ContactProblem& problem)
{
    RigidProxy proxy;
    proxy.m_center = at;
    for (std::size_t a = 0; a < 3; ++a)
        proxy.m_linearVelocity += hold.m_weights[a] * m_surfaces[hold.m_surface]->velocity()[hold.m_nodes[a]];
    problem.m_rigidProxies.push_back(proxy);
    m_holds.push_back(hold);
    return static_cast<int>(problem.m_rigidProxies.size()) - 1;
}

// The impulse acts on both sides at the cloth's point, since the cloth's proxy has no other moment arm. Cloth nodes
// that are attached to the body have no contact with it.
void ClothContacts::appendContact(const Search& search, const FemSoftBody& fem, const ClothContact& touch,
                                  ContactProblem& problem)
{
    const ClothSurface& cloth = *m_surfaces[search.m_surface];
    for (const ClothAttachment& held : fem.m_joints.m_clothAttachments)
        for (std::size_t a = 0; a < 3; ++a)
            if (held.m_cloth == &cloth.body() && touch.m_clothWeights[a] != 0 &&
                held.m_clothNode == touch.m_clothNodes[a])
                return;
    ContactPoint contact;
    contact.m_soft = fem.pointOn(search.m_body, touch.m_nodes, touch.m_weights);
    contact.m_point = touch.m_point;
    contact.m_normal = touch.m_normal;
    contact.m_gap = touch.m_gap;
    contact.m_slop = kSoftSlop * fem.m_surface.size();
    contact.m_hardness = std::max(0.0, double(std::min(fem.m_softBody->m_cfg.kSHR, cloth.body().m_cfg.kSHR)));
    contact.m_friction = frictionBetween(*fem.m_softBody, cloth.body());
    contact.m_rigidProxy = appendProxy(
        {search.m_surface, touch.m_clothNodes, touch.m_clothWeights, touch.m_onBody, problem.m_contacts.size()},
        touch.m_point, problem);
    problem.m_contacts.push_back(contact);
}

void ClothContacts::appendJoints(const Search& search, double step, ContactProblem& problem)
{
    FemSoftBody& fem = *(*m_bodies)[search.m_body];
    const ClothSurface& cloth = *m_surfaces[search.m_surface];
    if (!m_isUsable[search.m_surface]) return;
    for (const ClothAttachment& attachment : fem.m_joints.m_clothAttachments)
    {
        if (attachment.m_cloth != &cloth.body()) continue;
        const int node = attachment.m_clothNode;
        HeldJoint held;
        held.m_kind = HeldJoint::Kind::attachment;
        held.m_id = attachment.m_id;
        held.m_node = attachment.m_nodes[0];
        held.m_object = attachment.m_cloth;
        Joint joint;
        joint.m_a = pointEnd(search.m_body, attachment.m_nodes, attachment.m_weights, problem);
        for (std::size_t a = 0; a < 4; ++a)
            held.m_point += attachment.m_weights[a] * fem.m_body.m_state.m_x[attachment.m_nodes[a]];
        const Vec3 target = cloth.position()[node];
        held.m_error = norm(target - held.m_point);
        held.m_row = static_cast<int>(problem.m_joints.size());
        joint.m_wanted = (1 / step) * shortened(kErp * (target - held.m_point), longestCorrection(fem, step));
        joint.m_b.m_point = target;
        joint.m_b.m_rigidProxy = appendProxy(
            {search.m_surface, {node, node, node}, {1, 0, 0}, held.m_point, problem.m_joints.size()}, target, problem);
        if (const HeldJoint* before = continuedBy(held, fem.m_joints.m_before, fem.m_joints.m_now.size()))
            joint.m_impulse = before->m_impulse;
        problem.m_joints.push_back(joint);
        fem.m_joints.m_now.push_back(held);
    }
}

void ClothContacts::listUses()
{
    m_uses.clear();
    for (std::size_t k = 0; k < m_holds.size(); ++k)
        for (std::size_t a = 0; a < 3; ++a)
            if (m_holds[k].m_weights[a] != 0)
                m_uses.push_back(
                    {m_holds[k].m_surface, m_holds[k].m_nodes[a], static_cast<int>(k), m_holds[k].m_weights[a]});
    std::sort(m_uses.begin(), m_uses.end());
}

// An impulse on one proxy moves every proxy that shares nodes with it, by the sum of w w' / m over the shared nodes.
void ClothContacts::connect(ContactProblem& problem)
{
    m_answer.assign(m_holds.size(), 0);
    for (std::size_t k = 0; k < m_holds.size(); ++k)
    {
        const Hold& hold = m_holds[k];
        const std::vector<double>& inverseMass = m_surfaces[hold.m_surface]->inverseMass();
        m_answering.clear();
        for (std::size_t a = 0; a < 3; ++a)
        {
            if (hold.m_weights[a] == 0) continue;
            const double share = hold.m_weights[a] * inverseMass[hold.m_nodes[a]];
            const NodeUse from = {hold.m_surface, hold.m_nodes[a], 0, 0};
            for (auto use = std::lower_bound(m_uses.begin(), m_uses.end(), from);
                 share != 0 && use != m_uses.end() && use->isBeside(from); ++use)
            {
                if (m_answer[use->m_hold] == 0) m_answering.push_back(use->m_hold);
                m_answer[use->m_hold] += share * use->m_weight;
            }
        }
        RigidProxy& proxy = problem.m_rigidProxies[m_firstProxy + k];
        const double own = m_answer[k];
        proxy.m_inverseMass = {own, own, own};
        proxy.m_firstResponse = static_cast<int>(problem.m_responses.size());
        proxy.m_responseCount = static_cast<int>(m_answering.size());
        for (const int other : m_answering)
        {
            RigidResponse response;
            response.m_rigidProxy = static_cast<int>(m_firstProxy) + other;
            response.m_linear = Mat3::diagonal(m_answer[other]);
            problem.m_responses.push_back(response);
            m_answer[other] = 0;
        }
    }
}

void ClothContacts::applyReactions(const ContactProblem& problem)
{
    for (std::size_t k = 0; k < m_holds.size(); ++k)
    {
        const Hold& hold = m_holds[k];
        ClothSurface& cloth = *m_surfaces[hold.m_surface];
        const Vec3 impulse =
            k < m_contactCount ? -problem.m_contacts[hold.m_row].m_impulse : -problem.m_joints[hold.m_row].m_impulse;
        const Vec3 push = problem.m_rigidProxies[m_firstProxy + k].m_pushImpulse;
        for (std::size_t a = 0; a < 3; ++a)
        {
            const int node = hold.m_nodes[a];
            if (hold.m_weights[a] == 0) continue;
            const double pushed = cloth.step() * hold.m_weights[a] * cloth.inverseMass()[node];
            cloth.move(node, hold.m_weights[a] * impulse, pushed * push);
        }
    }
}

}  // namespace bullet_fem
