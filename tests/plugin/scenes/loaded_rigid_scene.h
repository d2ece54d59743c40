// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bullet_fem/bullet_bridge/vectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// Rigid bodies, Bullet's joints and payloads: soft cubes, which bring Bullet's contacts and joints into an island with
/// FEM bodies, or their rigid twins in Bullet's own world.
class LoadedRigidScene
{
public:
    static constexpr double kEdge = 0.1;                   ///< of a payload [m]
    static constexpr double kPayload = 1;                  ///< mass of a payload [kg]
    static constexpr Vec3 kTray = {0.4, 0.4, 0.05};        ///< edges of a body that carries a payload [m]
    static constexpr double kTrayMass = 2;                 ///< [kg]
    static constexpr double kLoad = kTrayMass + kPayload;  ///< of both [kg]
    static constexpr double kWeight = kLoad * kGravity;    ///< [N]
    static constexpr int kTwinIterations = 500;            ///< of Bullet's solver in the world of the rigid twins

    enum class Payload
    {
        soft,
        rigid  ///< of Bullet's world, without FEM bodies
    };

    explicit LoadedRigidScene(Coupling coupling, Payload payload = Payload::soft,
                              const btVector3& gravity = {0, 0, btScalar(-kGravity)}, const btFemSolverInfo& info = {})
        : m_world(WorldClass::softRigid, coupling, gravity, info), m_isSoft(payload == Payload::soft)
    {
        if (!m_isSoft) m_world.bullet().getSolverInfo().m_numIterations = kTwinIterations;
    }

    ~LoadedRigidScene()
    {
        for (const auto& joint : m_joints) m_world.bullet().removeConstraint(joint.get());
    }

    LoadedRigidScene(const LoadedRigidScene&) = delete;
    LoadedRigidScene& operator=(const LoadedRigidScene&) = delete;

    /// A rigid box with these edges and this centre [m].
    btRigidBody& addBox(const Vec3& size, double mass, const Vec3& center, double friction = 1)
    {
        RigidSettings settings{btScalar(mass), btTransform::getIdentity(), btScalar(friction)};
        settings.m_transform.setOrigin(bulletVector(center));
        return addRigidBox(m_world, size, settings);
    }

    /// A soft mat of 2 x 2 x 0.2 m on the floor, of 200 kg/m3, with `cells` along the longer edges.
    btSoftBody& addMat(int cells, double youngModulus)
    {
        SoftBox mat;
        mat.m_size = {2, 2, 0.2};
        mat.m_cells = {cells, cells, 1};
        mat.m_center = {0, 0, 0.1};
        mat.m_youngModulus = btScalar(youngModulus);
        mat.m_density = 200;
        return addSoftBox(m_world, m_world.fem(), mat);
    }

    /// A payload with its lower face at this point [m].
    void addPayload(const Vec3& foot, const Vec3& velocity = {})
    {
        if (!m_isSoft)
        {
            m_rigidPayloads.push_back(&addBox({kEdge, kEdge, kEdge}, kPayload, foot + Vec3{0, 0, kEdge / 2}));
            m_rigidPayloads.back()->setLinearVelocity(bulletVector(velocity));
            return;
        }
        SoftBox box;
        box.m_size = {kEdge, kEdge, kEdge};
        box.m_cells = {2, 2, 2};
        box.m_center = foot + Vec3{0, 0, kEdge / 2};
        box.m_youngModulus = btScalar(2e5);
        box.m_friction = 1;
        box.m_bending = btFemBending::plain;
        btSoftBody& cube = addSoftBox(m_world, m_world.fem(), box);
        for (int i = 0; i < cube.m_nodes.size(); ++i) cube.m_nodes[i].m_v = bulletVector(velocity);
        m_softPayloads.push_back(&cube);
    }

    /// A tray with this centre [m], and a payload on it.
    btRigidBody& addLoadedTray(const Vec3& center = {}, double friction = 1, const Vec3& velocity = {})
    {
        btRigidBody& tray = addBox(kTray, kTrayMass, center, friction);
        tray.setLinearVelocity(bulletVector(velocity));
        addPayload(center + Vec3{0, 0, kTray.z / 2}, velocity);
        return tray;
    }

    /// A payload whose lower face is anchored to a body.
    void anchorPayload(btRigidBody& body, const Vec3& foot)
    {
        addPayload(foot);
        btSoftBody& cube = *m_softPayloads.back();
        for (int i = 0; i < cube.m_nodes.size(); ++i)
            if (double(cube.m_nodes[i].m_x.z()) < foot.z + 0.1 * kEdge) cube.appendAnchor(i, &body, true);
    }

    /// Adds a joint; its bodies do not collide.
    template <class Joint, class... Arguments>
    Joint& join(Arguments&&... arguments)
    {
        auto* joint = new Joint(std::forward<Arguments>(arguments)...);
        m_joints.emplace_back(joint);
        m_feedback.push_back(std::make_unique<btJointFeedback>());
        joint->setJointFeedback(m_feedback.back().get());
        m_world.bullet().addConstraint(joint, true);
        return *joint;
    }

    /// Force of a joint on its first body in the last step [N].
    static Vec3 forceOf(const btTypedConstraint& joint) { return vec3(joint.getJointFeedback()->m_appliedForceBodyA); }

    /// True if a FEM body is in contact.
    bool touches() const
    {
        bool any = false;
        for (const btSoftBody* cube : m_softPayloads) any = any || m_world.fem().contacts(cube).size() > 0;
        return any;
    }

    /// True if positions and velocities of all payloads, and of these rigid bodies, are finite.
    bool allFinite(const std::vector<const btRigidBody*>& bodies) const
    {
        bool all = true;
        for (const btSoftBody* cube : m_softPayloads) all = all && bullet_fem::allFinite(*cube);
        for (const btRigidBody* body : bodies)
            for (const btScalar value : bitsOf(*body)) all = all && std::isfinite(value);
        return all;
    }

    FemWorld m_world;
    const bool m_isSoft;
    std::vector<btSoftBody*> m_softPayloads;
    std::vector<btRigidBody*> m_rigidPayloads;
    std::vector<std::unique_ptr<btTypedConstraint>> m_joints;

private:
    std::vector<std::unique_ptr<btJointFeedback>> m_feedback;
};

}  // namespace bullet_fem
