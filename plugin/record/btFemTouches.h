// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>
#include <vector>

#include "bullet_fem/btFemReports.h"

struct btFemBodyRecord;

/// As a step begins: what began goes on, and what ended is forgotten.
void ageTouches(btFemBodyRecord& record);

/// FEM bodies that are solved together, ascending by their objects.
using btFemTogether = std::vector<std::pair<const btCollisionObject*, const btFemBodyRecord*>>;

/// After contact is solved and the body's contact points are listed: what it touches now. `together` are the bodies
/// that it was solved with. The objects of contact points must be alive; those of touches need not be. Allocates when
/// the body touches more than ever.
void updateTouches(btFemBodyRecord& record, const btFemTogether& together);

/// The same on any thread, where nothing is touched that was not before; else false, and the touches wait for
/// updateTouches. Never allocates.
bool updateKnownTouches(btFemBodyRecord& record, const btFemTogether& together);

/// Gap up to which a touch that began lasts without an impulse [m]: so wide that a body at rest, which may lift off by
/// rounding for a step, goes on touching.
btScalar touchSlack(const btFemBodyRecord& record);

/// True if the point touches, or nearly does: it carries an impulse, or its gap is at most `slack` [m].
inline bool isTouch(const btFemContact& contact, btScalar slack)
{
    return contact.m_normalImpulse > 0 || contact.m_gap <= slack;
}

/// The touch of a body with an object that is in the world; null if they do not touch.
const btFemTouch* touchWith(const btFemBodyRecord& record, const btCollisionObject* other);
