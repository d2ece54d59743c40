// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btCollisionAlgorithm;
struct btCollisionAlgorithmConstructionInfo;
class btCollisionObject;
struct btCollisionObjectWrapper;
class btDispatcher;
class btSoftBody;

namespace bullet_fem
{

/// Makes a dispatcher call the soft body solver once for a FEM body and a rigid shape, with that shape, also as a
/// compound's child. Bullet's own algorithm for concave ones calls it once a triangle, with a hull that it makes and
/// keeps for every triangle, and looks for the triangles of a compound's child where the compound is. When such a pair
/// ends, because one of the two left the world or they parted, removeContactsWith is called. Bodies moved by Bullet's
/// springs keep Bullet's algorithms. Does nothing if `dispatcher` is null or no btCollisionDispatcher.
void dispatchRigidShapes(btDispatcher* dispatcher);

/// What the dispatcher's configuration has for a pair: for create functions that took its place, and are not meant.
btCollisionAlgorithm* createBulletsAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                             const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b);

/// What a body overlaps gets new collision algorithms at the next collision detection. Its m_worldInfo is not null.
void renewAlgorithms(btSoftBody& body);

/// Empties m_rcontacts, m_scontacts and the deformable contacts: they have pointers to objects that may be gone by the
/// next step.
void clearBulletContacts(btSoftBody& body);

/// Takes the contacts with an object out of m_rcontacts and m_faceRigidContacts: it may be deleted before anybody looks
/// there again. Leaves it alone.
void removeContactsWith(const btCollisionObject* object, btSoftBody& body);

}  // namespace bullet_fem
