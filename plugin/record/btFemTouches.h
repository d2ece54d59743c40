// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>
#include <vector>

#include "bullet_fem/btFemReports.h"

struct btFemBodyRecord;

/// Call at the beginning of a step: new contacts become lasting, and ended ones are removed.
void ageTouches(btFemBodyRecord& record);

/// FEM bodies that are solved together, ascending by object.
using btFemTogether = std::vector<std::pair<const btCollisionObject*, const btFemBodyRecord*>>;

/// Call after contact is solved and the body's contact points are listed: updates its contact pairs. `together` are the
/// bodies that it was solved with. The objects of contact points must be alive; those of pairs need not be. Allocates
/// if the body has more pairs than ever before.
void updateTouches(btFemBodyRecord& record, const btFemTogether& together);

/// Updates the contact pairs on any thread if no new pair begins, and returns true; otherwise returns false, and
/// updateTouches must be called. Never allocates.
bool updateKnownTouches(btFemBodyRecord& record, const btFemTogether& together);

/// Adds an impulse on the body [N s], with its normal component, to the contact pair with an object of a broadphase id,
/// which begins if it is new. May allocate then.
void addTouchImpulse(btFemBodyRecord& record, const btCollisionObject* other, int otherId, const btVector3& impulse,
                     btScalar normalImpulse);

/// Maximum gap of a lasting contact without impulse [m]: large enough that a body at rest, which may lift off by
/// rounding for a step, stays in contact.
btScalar touchSlack(const btFemBodyRecord& record);

/// True if the point carries an impulse, or its gap is at most `slack` [m].
inline bool isTouch(const btFemContact& contact, btScalar slack)
{
    return contact.m_normalImpulse > 0 || contact.m_gap <= slack;
}

/// The contact pair of a body and an object in the world; null if there is none.
const btFemTouch* touchWith(const btFemBodyRecord& record, const btCollisionObject* other);
