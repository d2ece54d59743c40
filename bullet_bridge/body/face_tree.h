// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btSoftBody;

namespace bullet_fem
{

/// Gives a body a tree of its faces (m_fdbvt), unless it has ours for its present faces. Bullet's rayTest and
/// rayFaceTest build one if there is none, and never return if the faces or nodes are not connected. Our tree has one
/// unbounded box for every face, so it needs no updates and rays find positions that the user writes to m_x at once.
/// This costs Bullet's rayTest little, since that tests every tetrahedron as well. Allocates when it builds the tree.
void keepFaceTree(btSoftBody& body);

/// Gives a body that Bullet's springs move a tree of its faces with their present boxes; Bullet updates them from then
/// on. Allocates when it builds the tree.
void giveFaceTreeToBullet(btSoftBody& body);

}  // namespace bullet_fem
