// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btSoftBody;

namespace bullet_fem
{

/// Gives a body a tree of its faces (m_fdbvt), unless it has ours for the faces that it has now. Bullet's rayTest and
/// rayFaceTest make one where there is none, and never return if the faces or nodes are not connected. Ours holds every
/// face in a box that nothing leaves: nobody has to keep it up to date, and what the user writes to m_x is found at
/// once. That costs Bullet's rayTest little, since it looks at every tetrahedron as well. Allocates when it makes one.
void keepFaceTree(btSoftBody& body);

/// The same with boxes as they are now, for a body that Bullet's springs move: Bullet keeps them from then on.
void giveFaceTreeToBullet(btSoftBody& body);

}  // namespace bullet_fem
