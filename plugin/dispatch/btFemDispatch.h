// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btSoftBody;

/// Makes the dispatcher of a body's world treat it as a FEM body from the next collision detection on: for rigid shapes
/// and contact tests, and by the second function for manifolds. No effect if the world info or the dispatcher is
/// unknown.
void announceToDispatcher(btSoftBody& body);
void announceWithManifolds(btSoftBody& body);
