// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"

class btDiscreteDynamicsWorld;
class btFemSoftBodySolver;

/// Saves and restores the complete state of a world: that of btFemSoftBodySolver::saveState, and Bullet's own.
///
/// Bullet's own are poses, velocities, forces and sleep of rigid bodies; joint positions, velocities and sleep of
/// multibodies; the trees of the broad phase, its pairs in order, and their contacts with warm starts; impulses of
/// joints, and which of them are broken; the seed of the rigid solver; the time that is left over between fixed steps.
/// A restored world continues with equal bits, also in another process, and saving does not change the run.
///
/// Not saved are settings that no step changes (shapes, masses, friction, gravity, motors and limits of joints), user
/// pointers of contact points, actions such as btRaycastVehicle, and soft bodies without tetrahedra. Bullet sorts the
/// trees of its broad phase by addresses; after a restored world has added objects or put them to sleep, the order of
/// new pairs of one object, and with it the last bits, may differ. So may they after children of movable compound
/// shapes came apart from others, for which Bullet keeps empty manifolds that cannot be made anew.
///
/// To be called between steps, from the thread that steps the world. The world must have a btDbvtBroadphase and a
/// btCollisionDispatcher. Functions with a last argument `why` throw if it is null; otherwise they write the reason
/// there and return false.
struct BULLETFEM_API btFemWorldState
{
    /// Saves the world, whose FEM bodies `fem` steps. `buffer` grows only if it is too small. Throws
    /// std::invalid_argument as saveState does, and on a world of other parts.
    static bool save(btDiscreteDynamicsWorld& world, const btFemSoftBodySolver& fem, std::vector<unsigned char>& buffer,
                     std::string* why = nullptr);

    /// Restores a state saved from this world, or from a world built alike: with equal objects, added in the order of
    /// that world. Throws std::invalid_argument with the reason, and changes nothing, as restoreState does, and on a
    /// world of other objects, joints or multibodies. Contact callbacks of Bullet are not called, but for
    /// gContactDestroyedCallback. Allocates.
    static bool restore(btDiscreteDynamicsWorld& world, btFemSoftBodySolver& fem, const unsigned char* data,
                        std::size_t size, std::string* why = nullptr);
};
