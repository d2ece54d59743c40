// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/record/btFemTouches.h"

#include <algorithm>

#include "bullet_bridge/rigid/rigid_proxies.h"
#include "plugin/record/btFemBodyRecord.h"

using namespace bullet_fem;

namespace
{

constexpr double kTouchSlack = 0.01;  // share of a mean edge length

/// The other object of contact points, which are grouped by object.
struct Other
{
    const btCollisionObject* m_object = nullptr;
    int m_id = 0;          // broadphase id
    btScalar m_slack = 0;  // maximum gap of a lasting contact of the two [m]
};

// Two FEM bodies must use equal values for their contact.
Other otherOf(const btFemBodyRecord& record, const btCollisionObject* object, const btFemTogether& together)
{
    Other other = {object, broadphaseId(*object), touchSlack(record)};
    const btFemTogether::value_type from(object, nullptr);
    const auto found = std::lower_bound(together.begin(), together.end(), from);
    if (found != together.end() && found->first == object)
        other.m_slack = std::min(other.m_slack, touchSlack(*found->second));
    return other;
}

btFemTouch* find(btAlignedObjectArray<btFemTouch>& touches, const Other& other)
{
    for (int k = 0; k < touches.size(); ++k)
        if (touches[k].m_other == other.m_object && touches[k].m_otherId == other.m_id) return &touches[k];
    return nullptr;
}

template <class Visitor>
void visitContacts(const btFemBodyRecord& record, const btFemTogether& together, const Visitor& visit)
{
    Other other;
    for (int k = 0; k < record.m_reports.m_contacts.size(); ++k)
    {
        const btFemContact& contact = record.m_reports.m_contacts[k];
        if (contact.m_other != other.m_object) other = otherOf(record, contact.m_other, together);
        visit(contact, other);
    }
}

}  // namespace

void ageTouches(btFemBodyRecord& record)
{
    btAlignedObjectArray<btFemTouch>& touches = record.m_reports.m_touches;
    int kept = 0;
    for (int k = 0; k < touches.size(); ++k)
    {
        if (touches[k].m_state == btFemTouchState::ended) continue;
        touches[kept] = touches[k];
        touches[kept++].m_state = btFemTouchState::lasting;
    }
    touches.resize(kept);
}

void updateTouches(btFemBodyRecord& record, const btFemTogether& together)
{
    btAlignedObjectArray<btFemTouch>& touches = record.m_reports.m_touches;
    visitContacts(record, together,
                  [&touches](const btFemContact& contact, const Other& other)
                  {
                      if (!isTouch(contact, 0) || find(touches, other)) return;
                      btFemTouch touch;
                      touch.m_other = other.m_object;
                      touch.m_otherId = other.m_id;
                      touch.m_state = btFemTouchState::began;
                      touches.push_back(touch);
                  });
    updateKnownTouches(record, together);
}

bool updateKnownTouches(btFemBodyRecord& record, const btFemTogether& together)
{
    btAlignedObjectArray<btFemTouch>& touches = record.m_reports.m_touches;
    for (int k = 0; k < touches.size(); ++k)
    {
        touches[k].m_points = 0;
        touches[k].m_impulse.setZero();
        touches[k].m_normalImpulse = 0;
    }
    bool areKnown = true;
    visitContacts(record, together,
                  [&](const btFemContact& contact, const Other& other)
                  {
                      if (!isTouch(contact, other.m_slack)) return;
                      btFemTouch* touch = find(touches, other);
                      if (touch)
                      {
                          ++touch->m_points;
                          touch->m_impulse += contact.m_impulse;
                          touch->m_normalImpulse += contact.m_normalImpulse;
                      }
                      else if (isTouch(contact, 0))
                          areKnown = false;
                  });
    if (!areKnown) return false;
    for (int k = 0; k < touches.size(); ++k)
        if (touches[k].m_points == 0) touches[k].m_state = btFemTouchState::ended;
    return true;
}

void addTouchImpulse(btFemBodyRecord& record, const btCollisionObject* other, int otherId, const btVector3& impulse,
                     btScalar normalImpulse)
{
    btAlignedObjectArray<btFemTouch>& touches = record.m_reports.m_touches;
    btFemTouch* touch = find(touches, {other, otherId, 0});
    if (!touch)
    {
        touches.push_back(btFemTouch());
        touch = &touches[touches.size() - 1];
        touch->m_other = other;
        touch->m_otherId = otherId;
    }
    if (touch->m_state == btFemTouchState::ended) touch->m_state = btFemTouchState::lasting;
    touch->m_points = std::max(touch->m_points, 1);
    touch->m_impulse += impulse;
    touch->m_normalImpulse += normalImpulse;
}

btScalar touchSlack(const btFemBodyRecord& record)
{
    return static_cast<btScalar>(kTouchSlack * record.fem().m_surface.meanEdge());
}

const btFemTouch* touchWith(const btFemBodyRecord& record, const btCollisionObject* other)
{
    const int id = broadphaseId(*other);
    for (int k = 0; k < record.m_reports.m_touches.size(); ++k)
    {
        const btFemTouch& touch = record.m_reports.m_touches[k];
        if (touch.m_other == other && touch.m_otherId == id && touch.m_state != btFemTouchState::ended) return &touch;
    }
    return nullptr;
}
