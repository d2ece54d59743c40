// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "plugin/record/btFemBodyRecord.h"

class btFemBodySetUp;

// Stages before collision detection.

/// Begins a body's step of the world's `worldStep` [s], and sets the body up if that is due. True if it is an active
/// FEM body.
bool beginBodyStep(btFemBodySetUp& setUp, btFemBodyRecord& record, double worldStep);

/// Reads the user's changes, lets Bullet add wind and pressure to m_f, and sets the bounds of the coming motion for the
/// broad phase. `step` is the body's [s]. May be called by several threads for different bodies.
void predictBody(btFemBodyRecord& record, double step);

/// Prepares all FEM bodies of the world, sleeping and new ones included: fits new leaves of the broad phase to their
/// bounds, and keeps Bullet's own soft body collision from having effect on them. `worldStep` [s].
void prepareForCollision(const btFemRecords& records, double worldStep);
