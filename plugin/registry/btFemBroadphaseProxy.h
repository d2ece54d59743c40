// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btSoftBody;

/// A world to which a body is added twice gives it a second proxy in the broad phase and loses the first; removed once,
/// it stays in the world without any, and Bullet's next step would follow a null pointer. This takes proxies that are
/// lost out of the broad phase, and gives a body of a world that has none a new one, with the filters of addSoftBody's
/// defaults. Needs the body's btSoftBodyWorldInfo with broad phase and dispatcher; without them nothing is done.
void restoreBroadphaseProxy(btSoftBody& body);
