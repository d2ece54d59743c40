// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/face_tree.h"

#include "BulletSoftBody/btSoftBody.h"

namespace bullet_fem
{
namespace
{

constexpr btScalar kEverywhere = btScalar(1e9);  // [m]; Bullet's limit for bodies is 1e6

bool isOurs(btSoftBody& body)
{
    // Bullet's own builder leaves m_leaves at 0. Faces that were reallocated keep the leaves of their former addresses.
    const int count = body.m_faces.size();
    return body.m_fdbvt.m_leaves == count && body.m_faces[0].m_leaf && body.m_faces[0].m_leaf->data == &body.m_faces[0];
}

void widen(btDbvtNode* node, const btDbvtVolume& volume)
{
    for (;; node = node->childs[1])
    {
        node->volume = volume;
        if (node->isleaf()) return;
        widen(node->childs[0], volume);
    }
}

}  // namespace

void keepFaceTree(btSoftBody& body)
{
    if (body.m_faces.size() > 0 && isOurs(body)) return;
    body.m_fdbvt.clear();
    if (body.m_faces.size() == 0) return;
    for (int i = 0; i < body.m_faces.size(); ++i)
    {
        btSoftBody::Face& face = body.m_faces[i];
        const btVector3 corners[3] = {face.m_n[0]->m_x, face.m_n[1]->m_x, face.m_n[2]->m_x};
        face.m_leaf = body.m_fdbvt.insert(btDbvtVolume::FromPoints(corners, 3), &face);
    }
    const btVector3 far(kEverywhere, kEverywhere, kEverywhere);
    widen(body.m_fdbvt.m_root, btDbvtVolume::FromMM(-far, far));
}

void giveFaceTreeToBullet(btSoftBody& body)
{
    keepFaceTree(body);
    body.updateFaceTree(false, true);
}

}  // namespace bullet_fem
