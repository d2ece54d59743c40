// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btSoftBody;

/// Makes the dispatcher of a body's world treat it as a FEM body from the next collision detection on: rigid shapes,
/// contact tests, and, of the second, manifolds. Nothing if its world info or the dispatcher is not known.
void announceToDispatcher(btSoftBody& body);
void announceWithManifolds(btSoftBody& body);
