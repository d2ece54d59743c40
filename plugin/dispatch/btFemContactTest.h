// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btDispatcher;

/// Makes contactTest and contactPairTest of a dispatcher's world report FEM bodies: the contact points of the last
/// step, at their positions at its beginning, between objects in the world. Reported are points in contact, and those
/// with a gap within the test's threshold. Later motion of the tested objects, and objects without contact response,
/// are ignored. No effect if `dispatcher` is null or no btCollisionDispatcher.
void answerContactTests(btDispatcher* dispatcher);
