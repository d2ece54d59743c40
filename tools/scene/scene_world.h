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

/// A scene as Bullet's world, in motion. It owns all that it makes.
class SceneWorld
{
public:
    /// Makes bodies, joints, anchors and welds, and factors. A body in pieces becomes as many soft bodies, also in
    /// description(). Throws std::runtime_error, or std::invalid_argument, that begins
    /// with the body's name: a file that is bad, a mesh or material that no body can have, a pin, anchor or force that
    /// holds no node.
    explicit SceneWorld(const SceneDescription& description);
    ~SceneWorld();
    SceneWorld(const SceneWorld&) = delete;
    SceneWorld& operator=(const SceneWorld&) = delete;

    /// Advances by the description's step.
    void step();
    double time() const { return double(m_steps) * m_description.m_step; }  ///< [s]
    long steps() const { return m_steps; }                                  ///< that were made

    /// @name Changes of a scene in motion. They are between steps, and the description tells what is there now.
    /// @{

    /// Adds a body after the others.
    void add(const SceneRigidBody& body);
    /// The same of a body that was made ready: it has the mesh, material and pins of `baked`. Throws like the
    /// constructor, and adds nothing then.
    void add(const SceneSoftBody& body, const BakedBody& baked);
    void setGravity(const Vec3& gravity);  ///< [m/s2]
    void setPictures(const ScenePictures& pictures) { m_description.m_pictures = pictures; }
    /// Sets the clock, for who restores a state of then: how many steps were made, >= 0.
    void setSteps(long steps);
    /// @}

    const SceneDescription& description() const { return m_description; }
    btSoftRigidDynamicsWorld& world() { return m_world; }
    btFemSoftBodySolver& fem() { return m_fem; }
    const btFemSoftBodySolver& fem() const { return m_fem; }
    int softCount() const { return static_cast<int>(m_softBodies.size()); }
    int rigidCount() const { return static_cast<int>(m_rigidBodies.size()); }
    /// In the description's order.
    btSoftBody& soft(int i) { return *m_softBodies[i]; }
    const btSoftBody& soft(int i) const { return *m_softBodies[i]; }
    btRigidBody& rigid(int i) { return *m_rigidBodies[i]; }
    const btRigidBody& rigid(int i) const { return *m_rigidBodies[i]; }
    const ElementMaterials& materials(int i) const { return m_materials[i]; }  ///< that a soft body started with
    /// Of a soft body's tetrahedra, as its file has them; empty if it has none.
    const std::vector<int>& regionLabels(int i) const { return m_regionLabels[i]; }
    const SceneFractures& fractures() const { return m_fractures; }  ///< what has split
    const SceneSensors& sensors() const { return m_sensors; }

private:
    /// A body that was cut.
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
    /// The soft body that the scene calls so, or its pieces.
    std::vector<btSoftBody*> softCalled(const std::string& name);

    SceneDescription m_description;  // of what is there now
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    // Before the world, which looks at them when it goes, also where the constructor throws.
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<std::unique_ptr<btRigidBody>> m_rigidBodies;
    SceneJoints m_joints;
    std::vector<std::unique_ptr<btSoftBody>> m_softBodies;
    std::vector<ElementMaterials> m_materials;     // of the soft bodies
    std::vector<std::vector<int>> m_regionLabels;  // likewise
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
