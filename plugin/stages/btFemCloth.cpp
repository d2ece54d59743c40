// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemCloth.h"

#include "bullet_bridge/body/face_tree.h"
#include "bullet_bridge/body/fem_soft_body.h"

using namespace bullet_fem;

void listCloth(const btFemBodyRegistry& registry, const btAlignedObjectArray<btSoftBody*>& bodies, ClothContacts& cloth)
{
    cloth.keepOnly(bodies);
    for (const auto& record : registry.records())
        if (record->isStepped()) cloth.noteAttached(record->fem(), bodies);
}

void updateWithoutTree(btSoftBody& body)
{
    if (!body.m_bUpdateRtCst || body.m_links.size() > 0) return;
    body.m_bUpdateRtCst = false;
    body.updateLinkConstants();
    body.updateArea();
    giveFaceTreeToBullet(body);
}
