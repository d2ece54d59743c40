// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

struct btFemBodyRecord;

namespace bullet_fem
{
class WorldObjects;
}

// Bullet's own contact arrays, m_rcontacts and m_faceRigidContacts, are filled for programs that read them, such as the
// drawing of btSoftBodyHelpers. Their solver constants are zero, so that no solver acts on them.

/// Call before writeBulletContacts. Allocates if there are more contacts than ever before.
void makeRoomForBulletContacts(const btFemBodyRecord& record);

/// Writes the contacts with rigid objects that are in the world, as the step began, like btFemContact. May be called by
/// several threads for different bodies once `world` has read the world of all of them.
void writeBulletContacts(btFemBodyRecord& record, bullet_fem::WorldObjects& world);
