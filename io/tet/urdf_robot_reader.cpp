// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "bullet_fem/io/urdf_robot.h"
#include "io/tet/urdf_elements.h"

namespace bullet_fem
{
namespace
{

using tinyxml2::XMLElement;

Vec3 vectorIn(const XMLElement& element, const char* attribute, const UrdfRange& range)
{
    double v[3];
    numbersIn(element, attribute, range, v, 3);
    return {v[0], v[1], v[2]};
}

UrdfPose poseIn(const XMLElement& parent)
{
    UrdfPose pose;
    const XMLElement* origin = parent.FirstChildElement("origin");
    if (!origin) return pose;
    if (origin->Attribute("xyz")) pose.m_position = vectorIn(*origin, "xyz", kFinite);
    if (origin->Attribute("rpy")) pose.m_turn = vectorIn(*origin, "rpy", kFinite);
    return pose;
}

/// Reads a file's links, joints and soft parts.
class RobotReader
{
public:
    explicit RobotReader(const std::string& path) : m_path(path) {}

    UrdfRobot read(const XMLElement& robot)
    {
        if (const char* name = robot.Attribute("name")) m_robot.m_name = name;
        noteOthers(robot, {"link", "joint", "deformable", "material"});
        for (const XMLElement* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
            readLink(*link);
        if (m_robot.m_links.empty()) failInUrdf(robot, "there is no <link> in it");
        for (const XMLElement* joint = robot.FirstChildElement("joint"); joint;
             joint = joint->NextSiblingElement("joint"))
            readJoint(*joint);
        sort(robot);
        for (const XMLElement* soft = robot.FirstChildElement("deformable"); soft;
             soft = soft->NextSiblingElement("deformable"))
            readSoftPart(*soft);
        return std::move(m_robot);
    }

private:
    void noteOthers(const XMLElement& parent, std::initializer_list<std::string_view> known)
    {
        for (const XMLElement* child = parent.FirstChildElement(); child; child = child->NextSiblingElement())
            if (std::find(known.begin(), known.end(), child->Name()) == known.end())
                m_robot.m_notes.push_back(message("line ", child->GetLineNum(), ": <", child->Name(), "> of <",
                                                  parent.Name(), "> is left out"));
    }

    void readInertial(const XMLElement& inertial, UrdfLink& link)
    {
        link.m_inertial = poseIn(inertial);
        readValue(inertial, "mass", kNotNegative, link.m_mass);
        const XMLElement* inertia = inertial.FirstChildElement("inertia");
        if (!inertia) return;
        const char* names[] = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
        for (std::size_t k = 0; k < 6; ++k)
        {
            const bool isDiagonal = k == 0 || k == 3 || k == 5;
            if (isDiagonal || inertia->Attribute(names[k]))
                link.m_inertia[k] = numberIn(*inertia, names[k], isDiagonal ? kNotNegative : kFinite);
        }
    }

    void readMesh(const XMLElement& mesh, UrdfShape& shape)
    {
        shape.m_kind = UrdfShape::Kind::hull;
        shape.m_meshPath = findMesh(mesh, m_path);
        shape.m_size = {1, 1, 1};
        if (mesh.Attribute("scale")) shape.m_size = vectorIn(mesh, "scale", kFinite);
    }

    void readCollision(const XMLElement& collision, UrdfLink& link)
    {
        UrdfShape shape;
        shape.m_pose = poseIn(collision);
        const XMLElement* geometry = collision.FirstChildElement("geometry");
        const XMLElement* element = geometry ? geometry->FirstChildElement() : nullptr;
        if (!element) failInUrdf(collision, "a <geometry> with a shape is missing");
        const std::string_view name = element->Name();
        if (name == "box")
            shape.m_size = vectorIn(*element, "size", kPositive);
        else if (name == "mesh")
            readMesh(*element, shape);
        else if (name == "sphere" || name == "cylinder" || name == "capsule")
        {
            shape.m_kind = name == "sphere"     ? UrdfShape::Kind::sphere
                           : name == "cylinder" ? UrdfShape::Kind::cylinder
                                                : UrdfShape::Kind::capsule;
            shape.m_radius = numberIn(*element, "radius", kPositive);
            if (name != "sphere") shape.m_length = numberIn(*element, "length", kPositive);
        }
        else
            failInUrdf(*element, "it must be a <box>, <sphere>, <cylinder>, <capsule> or <mesh>");
        link.m_collisions.push_back(std::move(shape));
    }

    void readLink(const XMLElement& element)
    {
        UrdfLink link;
        link.m_name = attributeOf(element, "name");
        if (indexOf(link.m_name) >= 0) failInUrdf(element, message("there are two links '", link.m_name, "'"));
        noteOthers(element, {"inertial", "collision", "visual", "contact"});
        if (const XMLElement* inertial = element.FirstChildElement("inertial")) readInertial(*inertial, link);
        for (const XMLElement* collision = element.FirstChildElement("collision"); collision;
             collision = collision->NextSiblingElement("collision"))
            readCollision(*collision, link);
        if (const XMLElement* contact = element.FirstChildElement("contact"))
            readValue(*contact, "lateral_friction", kNotNegative, link.m_friction);
        m_robot.m_links.push_back(std::move(link));
    }

    int indexOf(std::string_view name) const
    {
        for (std::size_t k = 0; k < m_robot.m_links.size(); ++k)
            if (m_robot.m_links[k].m_name == name) return int(k);
        return -1;
    }

    int linkOf(const XMLElement& element, const char* attribute) const
    {
        const char* name = attributeOf(element, attribute);
        const int link = indexOf(name);
        if (link < 0) failInUrdf(element, message("there is no link '", name, "'"));
        return link;
    }

    static UrdfJoint::Kind kindOf(const XMLElement& element)
    {
        const std::string_view type = attributeOf(element, "type");
        if (type == "fixed") return UrdfJoint::Kind::fixed;
        if (type == "revolute") return UrdfJoint::Kind::revolute;
        if (type == "continuous") return UrdfJoint::Kind::continuous;
        if (type == "prismatic") return UrdfJoint::Kind::prismatic;
        failInUrdf(element, message("type is '", type, "'; it must be fixed, revolute, continuous or prismatic"));
    }

    static void readLimit(const XMLElement& limit, UrdfJoint& joint)
    {
        if (joint.m_kind != UrdfJoint::Kind::continuous)
        {
            joint.m_lower = limit.Attribute("lower") ? numberIn(limit, "lower", kFinite) : 0;
            joint.m_upper = limit.Attribute("upper") ? numberIn(limit, "upper", kFinite) : 0;
            if (joint.m_lower > joint.m_upper)
                failInUrdf(limit, message("lower, ", joint.m_lower, ", is above upper, ", joint.m_upper));
        }
        if (limit.Attribute("effort")) joint.m_effort = numberIn(limit, "effort", kNotNegative);
        if (limit.Attribute("velocity")) joint.m_velocity = numberIn(limit, "velocity", kNotNegative);
    }

    void readJoint(const XMLElement& element)
    {
        UrdfJoint joint;
        joint.m_name = attributeOf(element, "name");
        joint.m_kind = kindOf(element);
        joint.m_pose = poseIn(element);
        noteOthers(element, {"origin", "parent", "child", "axis", "limit", "dynamics"});
        const XMLElement *parent = element.FirstChildElement("parent"), *child = element.FirstChildElement("child");
        if (!parent || !child) failInUrdf(element, "a <parent link=\"...\"/> or <child link=\"...\"/> is missing");
        joint.m_parent = linkOf(*parent, "link");
        joint.m_child = linkOf(*child, "link");
        if (const XMLElement* axis = element.FirstChildElement("axis"))
        {
            const Vec3 v = vectorIn(*axis, "xyz", kFinite);
            if (!(norm(v) > 0)) failInUrdf(*axis, "xyz is 0; it must be a direction");
            joint.m_axis = (1 / norm(v)) * v;
        }
        const XMLElement* limit = element.FirstChildElement("limit");
        const bool needsLimit = joint.m_kind == UrdfJoint::Kind::revolute || joint.m_kind == UrdfJoint::Kind::prismatic;
        if (needsLimit && !limit) failInUrdf(element, "a <limit> is missing; joints without one are continuous");
        if (limit) readLimit(*limit, joint);
        if (const XMLElement* dynamics = element.FirstChildElement("dynamics"))
            if (dynamics->Attribute("damping")) joint.m_damping = numberIn(*dynamics, "damping", kNotNegative);
        for (const UrdfJoint& other : m_robot.m_joints)
            if (other.m_child == joint.m_child || other.m_name == joint.m_name)
                failInUrdf(element, message("the joint '", other.m_name, "' has its name or its child, too"));
        m_robot.m_joints.push_back(std::move(joint));
    }

    // Puts every link behind its parent, and joints in the order of their children.
    void sort(const XMLElement& robot)
    {
        std::vector<UrdfJoint> joints;
        std::vector<int> order;  // old index of each link
        for (std::size_t k = 0; k < m_robot.m_links.size(); ++k)
            if (std::none_of(m_robot.m_joints.begin(), m_robot.m_joints.end(),
                             [k](const UrdfJoint& joint) { return joint.m_child == int(k); }))
                order.push_back(int(k));
        if (order.size() != 1)
            failInUrdf(robot, message("it has ", order.size(), " links without a parent; it must have one, the base"));
        for (std::size_t k = 0; k < order.size(); ++k)
            for (const UrdfJoint& joint : m_robot.m_joints)
                if (joint.m_parent == order[k])
                {
                    joints.push_back(joint);
                    joints.back().m_parent = int(k);
                    joints.back().m_child = int(order.size());
                    order.push_back(joint.m_child);
                }
        if (order.size() != m_robot.m_links.size()) failInUrdf(robot, "its joints make a circle; links must be a tree");
        std::vector<UrdfLink> links;
        for (const int old : order) links.push_back(std::move(m_robot.m_links[std::size_t(old)]));
        m_robot.m_links = std::move(links);
        m_robot.m_joints = std::move(joints);
    }

    void readSoftPart(const XMLElement& element)
    {
        UrdfSoftPart part;
        part.m_body = readDeformable(element, m_path);
        part.m_pose = poseIn(element);
        for (const XMLElement* attach = element.FirstChildElement("attach"); attach;
             attach = attach->NextSiblingElement("attach"))
        {
            UrdfAttachment attachment;
            attachment.m_link = linkOf(*attach, "link");
            double box[6];
            numbersIn(*attach, "box", kFinite, box, 6);
            attachment.m_low = {std::min(box[0], box[3]), std::min(box[1], box[4]), std::min(box[2], box[5])};
            attachment.m_high = {std::max(box[0], box[3]), std::max(box[1], box[4]), std::max(box[2], box[5])};
            part.m_attachments.push_back(attachment);
        }
        m_robot.m_softParts.push_back(std::move(part));
    }

    const std::string m_path;
    UrdfRobot m_robot;
};

}  // namespace

UrdfRobot readUrdfRobot(const std::string& path)
{
    return readUrdf(path, [&path](const XMLElement& robot) { return RobotReader(path).read(robot); });
}

}  // namespace bullet_fem
