// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btCollisionAlgorithm;
struct btCollisionAlgorithmConstructionInfo;
class btCollisionObject;
struct btCollisionObjectWrapper;
class btDispatcher;
struct btDispatcherInfo;
class btSoftBody;

namespace bullet_fem
{

/// Makes a dispatcher call the soft body solver once per FEM body and rigid shape, with the whole shape, also for a
/// child of a compound. Bullet's own algorithm for concave shapes calls it once per triangle with a hull that it
/// creates and keeps for every triangle, and searches a compound's child at the position of the compound. When such a
/// pair ends, because one of the two left the world or they separated, removeContactsWith() is called. Bodies moved by
/// Bullet's springs keep Bullet's algorithms. No effect if `dispatcher` is null or not a btCollisionDispatcher.
void dispatchRigidShapes(btDispatcher* dispatcher);

/// Calls checkInitialized() of the body's solver, during which dispatchInfoInUse() is `info`, that of the collision
/// detection in progress: Bullet's interface has no call that passes it on. Other solvers do nothing then.
void passDispatchInfo(const btSoftBody& body, const btDispatcherInfo& info);

/// The info that the present thread passes on; null if it passes none.
const btDispatcherInfo* dispatchInfoInUse();

/// Creates the algorithm of the dispatcher's configuration for a pair: for create functions that replaced it and do not
/// handle the pair.
btCollisionAlgorithm* createBulletsAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                             const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b);

/// Makes Bullet create new collision algorithms for the body's pairs at the next collision detection. m_worldInfo must
/// not be null.
void renewAlgorithms(btSoftBody& body);

/// Empties m_rcontacts, m_scontacts and the deformable contacts: they contain pointers to objects that may be deleted
/// before the next step.
void clearBulletContacts(btSoftBody& body);

/// Removes the contacts with an object from m_rcontacts and m_faceRigidContacts: it may be deleted before they are
/// used. Does not access the object.
void removeContactsWith(const btCollisionObject* object, btSoftBody& body);

}  // namespace bullet_fem
