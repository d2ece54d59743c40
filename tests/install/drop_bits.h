// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#ifdef BULLETFEM_AMALGAM
#include "bullet_fem_runtime.h"
#else
#include <bullet_fem/btFemSoftBodySolver.h>
#endif

#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "btBulletDynamicsCommon.h"

/// A world with a ground on which one soft body is dropped.
struct DropWorld
{
    ~DropWorld() { m_world.removeRigidBody(&m_ground); }

    /// Steps the body for five seconds, and returns the FNV-1a hash of its coordinates' bits.
    std::uint64_t bitsAfterDrop(btSoftBody* body)
    {
        m_world.addRigidBody(&m_ground);
        m_world.addSoftBody(body);
        for (int i = 0; i < 300; ++i) m_world.stepSimulation(btScalar(1) / 60, 1, btScalar(1) / 60);
        m_touches = m_fem.contacts(body).size() > 0;
        m_baked = m_fem.stepReport(body).m_bakedFactor;
        std::uint64_t hash = 14695981039346656037u;
        for (int i = 0; i < body->m_nodes.size(); ++i)
            for (int c = 0; c < 3; ++c)
            {
                const btScalar x = body->m_nodes[i].m_x[c];
                unsigned char bytes[sizeof x];
                std::memcpy(bytes, &x, sizeof x);
                for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211u;
            }
        m_world.removeSoftBody(body);
        delete body;
        return hash;
    }

    btSoftBodyRigidBodyCollisionConfiguration m_config;
    btCollisionDispatcher m_dispatcher{&m_config};
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    btFemSoftBodySolver m_fem;
    btSoftRigidDynamicsWorld m_world{&m_dispatcher, &m_broadphase, &m_rigidSolver, &m_config, &m_fem};
    btStaticPlaneShape m_plane{btVector3(0, 1, 0), 0};
    btRigidBody m_ground{0, nullptr, &m_plane};
    bool m_touches = false, m_baked = false;  ///< at the end
};
