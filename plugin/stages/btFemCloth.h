// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/contact/cloth/cloth_contacts.h"
#include "plugin/registry/btFemBodyRegistry.h"

/// Forgets cloth that is none of `bodies`, and pairs the others with the FEM bodies that they are attached to. Before
/// contact with cloth is looked for.
void listCloth(const btFemBodyRegistry& registry, const btAlignedObjectArray<btSoftBody*>& bodies,
               bullet_fem::ClothContacts& cloth);

/// Bullet builds its tree of nodes along the links, and never ends without any: helpers' bodies have none. Makes one
/// that finite elements do not move ready for Bullet.
void updateWithoutTree(btSoftBody& body);
