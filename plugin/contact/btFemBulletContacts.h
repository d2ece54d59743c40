// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

class btFemBodyRegistry;
class btSoftBody;
struct btFemEntry;

/// Which of m_faces the triangles of a body's surface are.
struct btFemFaceIndex
{
    std::vector<int> m_faceOf;      // per surface triangle; -1: none of them
    const void* m_first = nullptr;  // where m_faces was when this was made
    int m_count = -1;               // and how many they were
};

// Bullet's own contact arrays, m_rcontacts and m_faceRigidContacts, are only for those who read them: btSoftBodyHelpers
// draws them, others list them. Their solver constants are such that nobody would act on them.

/// Empties them: they have pointers to objects that may be gone by the next step.
void clearBulletContacts(btSoftBody& body);

/// Before writeBulletContacts: allocates where there are more contacts than ever.
void makeRoomForBulletContacts(const btFemEntry& entry);

/// Fills them with what touches rigid objects that the world holds: as the step began, like btFemContact. May be called
/// by several threads for different bodies once btFemBodyRegistry::readWorld has said so.
void writeBulletContacts(btFemEntry& entry, btFemBodyRegistry& registry);
