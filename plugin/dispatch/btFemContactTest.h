// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btDispatcher;

/// Makes contactTest and contactPairTest of a dispatcher's world see FEM bodies: they tell the contact points of the
/// last step, as they were when it began, between objects that the world holds. Points are told that touch, and those
/// whose gap is within the test's own threshold. What the test's objects did since, or objects that have no contact
/// response, are not looked at. Does nothing if `dispatcher` is null or no btCollisionDispatcher.
void answerContactTests(btDispatcher* dispatcher);
