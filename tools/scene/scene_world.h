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
#include "bullet_fem/fem/mesh/element_materials.h"
#include "tools/scene/scene_actuators.h"
#include "tools/scene/scene_description.h"
#include "tools/scene/scene_forces.h"
#include "tools/scene/scene_fractures.h"
#include "tools/scene/scene_joints.h"
#include "tools/scene/scene_sensors.h"
#include "tools/scene/scene_springs.h"
#include "tools/scene/scene_welds.h"
#include "tools/scene/scene_world_materials.h"

namespace bullet_fem
{

struct BakedBody;

/// A scene as a running Bullet world. It owns all objects that it creates.
class SceneWorld
{
public:
    /// Creates and factors bodies, then joints, anchors and welds. A divided body becomes several soft bodies, also in
    /// description(). Throws std::runtime_error or std::invalid_argument with the body's name: an invalid file, an
    /// unsuitable mesh or material, a pin, anchor or force without nodes.
    /// holds no node.
    explicit SceneWorld(const SceneDescription& description);
    ~SceneWorld();
    SceneWorld(const SceneWorld&) = delete;
    SceneWorld& operator=(const SceneWorld&) = delete;

    /// Advances by the description's step.
    void step();
    double time() const { return double(m_steps) * m_description.m_step; }  ///< [s]
    long steps() const { return m_steps; }                                  ///< number of steps made

    /// @name Changes between steps; the description is kept up to date.
    /// @{

    /// Appends a rigid body.
    void add(const SceneRigidBody& body);
    /// Appends a soft body with mesh, material and pins from `baked`. Throws as the constructor does, without any
    /// change.
    void add(const SceneSoftBody& body, const BakedBody& baked);
    void setGravity(const Vec3& gravity);  ///< [m/s2]
    void setPictures(const ScenePictures& pictures) { m_description.m_pictures = pictures; }
    /// Sets the clock for a restored state: number of steps made, >= 0.
    void setSteps(long steps);
    /// @}

    const SceneDescription& description() const { return m_description; }
    btSoftRigidDynamicsWorld& world() { return m_world; }
    btFemSoftBodySolver& fem() { return m_fem; }
    const btFemSoftBodySolver& fem() const { return m_fem; }
    int softCount() const { return static_cast<int>(m_softBodies.size()); }
    int rigidCount() const { return static_cast<int>(m_rigidBodies.size()); }
    /// Soft body by its index in the description.
    btSoftBody& soft(int i) { return *m_softBodies[i]; }
    const btSoftBody& soft(int i) const { return *m_softBodies[i]; }
    btRigidBody& rigid(int i) { return *m_rigidBodies[i]; }
    const btRigidBody& rigid(int i) const { return *m_rigidBodies[i]; }
    const ElementMaterials& materials(int i) const { return m_materials[i]; }  ///< initial materials of a soft body
    /// Region labels of a soft body's tetrahedra from its file; empty if it has none.
    const std::vector<int>& regionLabels(int i) const { return m_regionLabels[i]; }
    const SceneFractures& fractures() const { return m_fractures; }  ///< splits so far
    const SceneSensors& sensors() const { return m_sensors; }

private:
    /// A divided body.
    struct CutBody
    {
        std::string m_name;
        std::vector<btFemPiece> m_pieces;
        SceneWeldStrength m_strength;
    };
    void addSoftBodies(const std::vector<SceneSoftBody>& bodies);
    void addSoft(const SceneSoftBody& from, std::unique_ptr<btSoftBody> body);
    void addPieces(const SceneSoftBody& from);
    void weldBodies();
    void addRigid(const SceneRigidBody& from);
    void addConstraint(const SceneConstraint& from);
    void addAnchors(const SceneConstraint& from);
    std::unique_ptr<btSoftBody> makeSoft(const SceneSoftBody& from);
    std::unique_ptr<btSoftBody> makeBaked(const BakedBody& baked);
    void giveMaterials(btSoftBody& body, const SceneSoftBody& from);
    void addForce(const SceneForce& from);
    void moveKinematic(double middle);
    btRigidBody& rigidCalled(const std::string& name);
    /// The soft body with that name, or its fragments.
    std::vector<btSoftBody*> softCalled(const std::string& name);

    SceneDescription m_description;  // kept up to date
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    // Declared before the world, whose destructor accesses the shapes, even after an exception in the constructor.
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<std::unique_ptr<btRigidBody>> m_rigidBodies;
    SceneJoints m_joints;
    std::vector<std::unique_ptr<btSoftBody>> m_softBodies;
    std::vector<ElementMaterials> m_materials;     // of the soft bodies
    std::vector<std::vector<int>> m_regionLabels;  // of the soft bodies
    btFemSoftBodySolver m_fem;
    std::unique_ptr<btConstraintSolver> m_rigidSolver;
    btSoftRigidDynamicsWorld m_world;
    std::vector<CutBody> m_cutBodies;
    SceneForces m_forces;
    SceneSprings m_springs;
    SceneActuators m_actuators;
    SceneFractures m_fractures;
    SceneSensors m_sensors;
    long m_steps = 0;
};

}  // namespace bullet_fem
