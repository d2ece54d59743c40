// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/vec3.h"
#include "bullet_fem/io/urdf_deformable.h"

namespace bullet_fem
{

/// `<origin xyz="..." rpy="..."/>`
struct UrdfPose
{
    Vec3 m_position;  ///< [m]
    Vec3 m_turn;      ///< roll, pitch and yaw about fixed axes [rad]
};

/// The shape of a `<collision>`.
struct UrdfShape
{
    enum class Kind
    {
        box,
        sphere,
        cylinder,  ///< along z
        capsule,   ///< along z; its length is that of the cylinder between the half spheres
        hull       ///< convex hull of a mesh
    };
    Kind m_kind = Kind::box;
    UrdfPose m_pose;         ///< in the frame of its link
    Vec3 m_size{0, 0, 0};    ///< edges of a box [m], > 0; scale of a mesh [-]
    double m_radius = 0;     ///< [m], > 0
    double m_length = 0;     ///< [m], > 0
    std::string m_meshPath;  ///< file of a hull's surface
};

/// A `<link>`.
struct UrdfLink
{
    std::string m_name;
    double m_mass = 0;                    ///< [kg], >= 0
    UrdfPose m_inertial;                  ///< centre of mass and axes of the inertia, in the frame of the link
    std::array<double, 6> m_inertia{};    ///< ixx, ixy, ixz, iyy, iyz, izz [kg m2]
    std::vector<UrdfShape> m_collisions;  ///< may be empty
    double m_friction = 0.5;              ///< `<contact><lateral_friction>` [-], >= 0
};

/// A `<joint>`.
struct UrdfJoint
{
    enum class Kind
    {
        fixed,
        revolute,
        continuous,
        prismatic
    };
    Kind m_kind = Kind::fixed;
    std::string m_name;
    int m_parent = 0, m_child = 0;  ///< indices of links
    UrdfPose m_pose;                ///< of the child's frame in the parent's, where the joint is at 0
    Vec3 m_axis{1, 0, 0};           ///< in the child's frame, of length 1
    /// Limits of the position [rad] or [m]; infinite for continuous joints.
    double m_lower = -std::numeric_limits<double>::infinity(), m_upper = std::numeric_limits<double>::infinity();
    double m_effort = 0;    ///< largest force [N] or torque [N m] of its motor; 0: not given
    double m_velocity = 0;  ///< largest speed [m/s] or [rad/s]; 0: not given
    double m_damping = 0;   ///< [N s/m] or [N m s/rad], >= 0
};

/// `<attach link="..." box="x y z x y z"/>` of a `<deformable>`: nodes that are tied to a link.
struct UrdfAttachment
{
    int m_link = 0;
    Vec3 m_low, m_high;  ///< box that holds the nodes, in the frame of the link [m]
};

/// A `<deformable>` beside links.
struct UrdfSoftPart
{
    UrdfDeformable m_body;
    UrdfPose m_pose;  ///< `<origin>`: place of the mesh in the frame of the base, with all joints at 0
    std::vector<UrdfAttachment> m_attachments;
};

/// A robot of links, joints and soft parts.
struct UrdfRobot
{
    std::string m_name;
    std::vector<UrdfLink> m_links;    ///< the first is the base; each stands behind its parent
    std::vector<UrdfJoint> m_joints;  ///< joint k moves link k + 1
    std::vector<UrdfSoftPart> m_softParts;
    std::vector<std::string> m_notes;  ///< what was left out, with its line
};

/// Reads a robot from a URDF file. Links form a tree. Mesh files are searched as readUrdfDeformable does.
/// Transmissions, sensors, visuals, mimics, Gazebo's and other elements are noted and left out. Throws
/// std::runtime_error naming file, line, the contents found and expected: a file that is missing, unreadable or not
/// XML; links without a common base or with two parents; a joint of another type; an element or attribute missing; a
/// number out of range. Allocates.
BULLETFEM_API UrdfRobot readUrdfRobot(const std::string& path);

}  // namespace bullet_fem
