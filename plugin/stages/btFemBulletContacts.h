// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

struct btFemBodyRecord;

namespace bullet_fem
{
class WorldObjects;
}

// Bullet's own contact arrays, m_rcontacts and m_faceRigidContacts, are only for those who read them: btSoftBodyHelpers
// draws them, others list them. Their solver constants are such that nobody would act on them.

/// Before writeBulletContacts: allocates where there are more contacts than ever.
void makeRoomForBulletContacts(const btFemBodyRecord& record);

/// Fills them with what touches rigid objects that the world holds: as the step began, like btFemContact. May be called
/// by several threads for different bodies once `world` has read the world of all of them.
void writeBulletContacts(btFemBodyRecord& record, bullet_fem::WorldObjects& world);
