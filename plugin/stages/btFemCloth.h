// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/contact/cloth/cloth_contacts.h"
#include "plugin/registry/btFemBodyRegistry.h"

/// Forgets cloth that is not in `bodies`, and pairs the others with the FEM bodies that they are attached to. Call
/// before contact with cloth is searched.
void listCloth(const btFemBodyRegistry& registry, const btAlignedObjectArray<btSoftBody*>& bodies,
               bullet_fem::ClothContacts& cloth);

/// Prepares a body that is not FEM and has no links for Bullet: Bullet builds its tree of nodes along the links, and
/// never returns if there are none, as in bodies made by helpers.
void updateWithoutTree(btSoftBody& body);
