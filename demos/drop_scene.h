// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "btBulletDynamicsCommon.h"
#include "bullet_fem/btFemConstraintSolver.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/cage/cage_report.h"
#include "demos/drop_options.h"
#include "demos/drop_size.h"

class btSoftBody;

namespace bullet_fem
{

/// A soft body above a tilted box on a plane, with rigid boxes above it. y is up. Lengths are multiples of the body's
/// longest side, so that the scene looks alike at all scales.
class DropScene
{
public:
    /// Builds the world and factors the body for options.m_step. Throws std::runtime_error on an unreadable file,
    /// std::invalid_argument on an unsuitable surface, cell or material.
    DropScene(const DropOptions& options, const DropSize& size);
    ~DropScene();
    DropScene(const DropScene&) = delete;
    DropScene& operator=(const DropScene&) = delete;

    void step();  ///< by options.m_step

    const btSoftBody& softBody() const { return *m_softBody; }
    const CageReport& cage() const { return m_cage; }  ///< of the body's cage
    const btFemStepReport& report() const { return m_fem.stepReport(m_softBody.get()); }
    const btAlignedObjectArray<btFemContact>& contacts() const { return m_fem.contacts(m_softBody.get()); }
    void getStress(btAlignedObjectArray<btFemStress>& perNode) const  ///< [Pa]
    {
        m_fem.getNodeStress(m_softBody.get(), perNode);
    }
    /// The static tilted box first, then the falling boxes.
    const std::vector<std::unique_ptr<btRigidBody>>& boxes() const { return m_boxes; }
    btVector3 gravity() const { return m_world.getGravity(); }  ///< [m/s2]
    double length() const { return m_length; }                  ///< longest side of the body at the start [m]
    double stepSize() const { return m_step; }                  ///< h [s]

private:
    void addPlane();
    void addRamp();
    void addSoftBody(const DropOptions& options, const DropSize& size);
    void addFallingBoxes();
    btRigidBody* addBox(const btVector3& halfExtents, const btTransform& pose, double density);

    double m_length, m_step;
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    btFemSoftBodySolver m_fem;
    btFemConstraintSolver m_rigidSolver{&m_fem};
    btSoftRigidDynamicsWorld m_world{&m_dispatcher, &m_broadphase, &m_rigidSolver, &m_configuration, &m_fem};
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::unique_ptr<btRigidBody> m_plane;
    std::vector<std::unique_ptr<btRigidBody>> m_boxes;
    std::unique_ptr<btSoftBody> m_softBody;
    CageReport m_cage;
};

}  // namespace bullet_fem
