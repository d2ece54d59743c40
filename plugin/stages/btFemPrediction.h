// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "plugin/record/btFemBodyRecord.h"

class btFemBodySetUp;

// Before collision detection.

/// Begins a body's step, and sets it up if that is due. False if it is not a FEM body that moves.
bool beginBodyStep(btFemBodySetUp& setUp, btFemBodyRecord& record, double worldStep);

/// Takes over what the user wrote, lets Bullet add wind and pressure to m_f, and gives the broad phase the bounds of
/// the motion to come. `step` [s] is the body's. May be called by several threads for different bodies.
void predictBody(btFemBodyRecord& record, double step);

/// Of all bodies of the world, also of those that sleep or have just become FEM: leaves Bullet's own collision nothing
/// to do.
void prepareForCollision(const btFemRecords& records);
