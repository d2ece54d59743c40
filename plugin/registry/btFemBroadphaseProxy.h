// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btSoftBody;

/// Repairs the broad phase of a body that was added to a world twice: the world then gives it a second proxy and loses
/// the first. Removed once, the body is still in the world without a proxy, and Bullet's next step would follow a null
/// pointer. This destroys lost proxies, and gives a body without one a new proxy with the default filters of
/// addSoftBody. Needs the body's btSoftBodyWorldInfo with broad phase and dispatcher; no effect without them.
void restoreBroadphaseProxy(btSoftBody& body);

/// Fits the body's leaf in a btDbvtBroadphase to its bounds. Bullet made the leaf with the collision margin, 25 cm
/// unless set, and shrinks none that its object stays in: small bodies would overlap dozens of others for ever. No
/// effect without a leaf in the tree of the body's btSoftBodyWorldInfo.
void fitBroadphaseLeaf(btSoftBody& body);
