// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h"
#include "BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h"
#include "BulletDynamics/Featherstone/btMultiBodyJointMotor.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "bullet_fem/io/urdf_robot.h"
#include "python/core/rigid_shape.h"

namespace bullet_fem::python
{

class World;

/// The multibody of a URDF file, with its colliders, limits and motors, in a world.
class Robot
{
public:
    /// `base`: pose of the base link's frame. Throws std::invalid_argument on links that have joints but no mass, and
    /// std::runtime_error on meshes that are not read.
    Robot(btMultiBodyDynamicsWorld& world, const UrdfRobot& description, const btTransform& base, bool isFixed,
          double step);
    /// Removes it from the world.
    ~Robot();
    Robot(const Robot&) = delete;
    Robot& operator=(const Robot&) = delete;

    const UrdfRobot& description() const { return m_description; }
    btMultiBody& body() { return *m_body; }
    int linkCount() const { return int(m_colliders.size()); }
    /// Throw std::out_of_range on unknown names.
    int linkCalled(const std::string& name) const;
    int jointCalled(const std::string& name) const;  ///< of those that move
    /// Joints that move, as indices of description().m_joints.
    const std::vector<int>& joints() const { return m_moving; }

    btMultiBodyLinkCollider& collider(int link) { return *m_colliders[std::size_t(link)]; }
    /// The frame of the link as the file has it, in the world.
    btTransform frameOf(int link) const;

    /// Positions of the joints that move [rad], [m].
    void setPositions(const std::vector<double>& positions);

    /// The motor of joint `k` of joints(); its largest force is 0 in the beginning.
    struct Motor
    {
        double m_velocity = 0;         ///< wanted [rad/s], [m/s]
        double m_position = 0;         ///< wanted [rad], [m]; if m_gain > 0
        double m_gain = 0;             ///< share of the position's error that a step removes [-]
        double m_largestVelocity = 0;  ///< [rad/s], [m/s]
        double m_largestForce = 0;     ///< [N m], [N]
    };
    void setMotor(int k, const Motor& motor);
    /// Adds the joints' damping to the forces of the next step, which Bullet does not do.
    void addDamping();
    /// Force of a motor in the last step [N m], [N].
    double motorForce(int k) const;

private:
    void setUpLinks(const btTransform& base, bool isFixed);
    void addCollider(int link, bool isFixed);
    void addLimitsAndMotors();
    void moveColliders();

    btMultiBodyDynamicsWorld& m_world;
    const UrdfRobot m_description;
    const double m_step;  // [s]
    std::vector<std::shared_ptr<RigidShape>> m_hulls;
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;  // of links, then children of compounds
    std::vector<btTransform> m_inertial;                      // centre of mass and axes of each link, in its frame
    std::unique_ptr<btMultiBody> m_body;
    std::vector<std::unique_ptr<btMultiBodyLinkCollider>> m_colliders;
    std::vector<int> m_moving;
    std::vector<std::unique_ptr<btMultiBodyJointLimitConstraint>> m_limits;
    std::vector<std::unique_ptr<btMultiBodyJointMotor>> m_motors;
};

}  // namespace bullet_fem::python
