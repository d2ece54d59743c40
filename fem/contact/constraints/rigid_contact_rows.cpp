// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <cmath>

#include "fem/contact/constraints/contact_rows.h"
#include "fem/contact/contact_tuning.h"

namespace bullet_fem
{
namespace
{

constexpr double kAnySpeed = 1e300;  // [m/s]

}  // namespace

void ContactRows::addRigidContactRow(const RigidContact& touch)
{
    ContactRow row;
    row.m_touch = true;
    row.m_a.m_rigidProxy = touch.m_rigidProxy;
    row.m_a.m_arm = touch.m_arm;
    row.m_b.m_rigidProxy = touch.m_other;
    row.m_b.m_arm = touch.m_otherArm;
    setAxes(touch.m_normal, row);
    if (touch.m_aspect != 1)
    {
        row.m_aspect = touch.m_aspect;
        row.m_axes[1] = touch.m_slipAxis;
        row.m_axes[2] = cross(touch.m_normal, touch.m_slipAxis);
    }
    for (int i = 0; i < 3; ++i) row.m_target[i] = dot(touch.m_otherVelocity, row.m_axes[i]);
    row.m_target.x += touch.m_pushOnly ? -kAnySpeed : touch.m_leastSpeed;
    row.m_friction = touch.m_friction;
    row.m_yield.x = touch.m_compliance;
    row.m_impulse = touch.m_impulse;
    m_rows.push_back(row);
}

// Friction may increase the normal load by its lever arm; beyond this share the load would have no bound [Painleve
// 1895], and led bodies with a friction coefficient of 10 stop dead.
void ContactRows::limitContactFriction(ContactRow& row)
{
    const Vec3 byNormal = row.m_compliance * row.m_axes[0];
    const double lever = std::hypot(dot(byNormal, row.m_axes[1]), dot(byNormal, row.m_axes[2]));
    row.m_friction = std::min(row.m_friction, kMaxPressing * dot(byNormal, row.m_axes[0]) / std::max(lever, 1e-300));
}

// Warm-start impulses of other rows push rigid proxies into their supports. The reaction to this is no change for which
// the contact solve must account.
bool ContactRows::settleRigidContacts()
{
    const std::size_t first = m_problem->m_contacts.size() + m_problem->m_joints.size();
    const std::size_t end = first + m_problem->m_rigidContacts.size();
    double most = 0, largest = 1;  // maximum changes, of all sweeps and of the last [m/s]
    for (int sweep = 0; sweep < kMaxOtherSweeps && largest > kTouchesSettled * most; ++sweep)
    {
        largest = 0;
        for (std::size_t k = first; k < end; ++k)
        {
            ContactRow& row = m_rows[k];
            const Vec3 wanted = wantedImpulse(row, row.m_impulse, velocity(row), 1);
            largest = std::max(largest, speedOf(row, wanted - row.m_impulse));
            change(row, wanted);
        }
        most = std::max(most, largest);
    }
    return first < end;
}

}  // namespace bullet_fem
