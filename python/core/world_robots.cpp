// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/world_robots.h"

#include <stdexcept>
#include <utility>

#include "bullet_fem/btFemVectors.h"
#include "python/core/soft_maker.h"

namespace bullet_fem::python
{
namespace
{

btTransform poseOfPart(const UrdfPose& pose)
{
    btQuaternion turn;
    turn.setEulerZYX(pose.m_turn.z, pose.m_turn.y, pose.m_turn.x);
    return btTransform(turn, bulletVector(pose.m_position));
}

double volumeOf(const TetMesh& mesh)
{
    double volume = 0;
    const std::vector<Vec3>& x = mesh.restPositions();
    for (const Tet& tet : mesh.tets())
    {
        const Vec3 &a = x[std::size_t(tet[0])], &b = x[std::size_t(tet[1])], &c = x[std::size_t(tet[2])],
                   &d = x[std::size_t(tet[3])];
        volume += std::abs(dot(cross(b - a, c - a), d - a)) / 6;
    }
    return volume;
}

bool isIn(const UrdfAttachment& box, const btVector3& p)
{
    return p.x() >= box.m_low.x && p.y() >= box.m_low.y && p.z() >= box.m_low.z && p.x() <= box.m_high.x &&
           p.y() <= box.m_high.y && p.z() <= box.m_high.z;
}

// The part must not be pushed away by the link that holds it.
void attach(btSoftBody& body, Robot& robot, const UrdfAttachment& attachment, const std::string& part)
{
    const btTransform toLink = robot.frameOf(attachment.m_link).inverse();
    btMultiBodyLinkCollider& collider = robot.collider(attachment.m_link);
    int count = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        if (!isIn(attachment, toLink * body.m_nodes[i].m_x)) continue;
        body.appendDeformableAnchor(i, &collider);
        ++count;
    }
    if (count == 0)
        throw std::invalid_argument("<attach> of <deformable> '" + part + "' holds no node: its box is empty");
    body.m_collisionDisabledObjects.push_back(&collider);
}

int addPart(World& world, Robot& robot, const UrdfSoftPart& part, const btTransform& base, const std::string& name)
{
    const UrdfDeformable& from = part.m_body;
    const Mesh mesh = Mesh::ofFile(from.m_meshPath, 1);
    SoftRequest request;
    request.m_mesh = &mesh;
    Material& material = request.m_materials.m_base;
    material.m_density = from.m_mass / volumeOf(mesh.m_tets);
    material.m_stiffnessDamping = from.m_damping;
    if (from.m_elastic)
    {
        material.m_youngModulus = from.m_moduli.youngModulus();
        material.m_poissonRatio = from.m_moduli.poissonRatio();
    }
    request.m_pose = base * poseOfPart(part.m_pose);
    request.m_velocity.setZero();
    request.m_friction = from.m_friction;
    request.m_name = name + "." + from.m_name;
    const int index = addSoft(world, request);
    btSoftBody& body = *world.bodies().soft(index).m_body;
    try
    {
        body.setGravityFactor(btScalar(from.m_gravityFactor));
        for (const UrdfAttachment& attachment : part.m_attachments) attach(body, robot, attachment, from.m_name);
    }
    catch (...)
    {
        world.removeBody(index);
        throw;
    }
    return index;
}

}  // namespace

WorldRobots::Added WorldRobots::add(World& world, const UrdfRobot& description, const btTransform& base, bool isFixed,
                                    const std::string& name)
{
    auto* multi = dynamic_cast<btMultiBodyDynamicsWorld*>(&world.bullet().world());
    if (!multi) throw std::invalid_argument("the world must be of kind 'multibody' to have robots");
    auto robot = std::make_unique<Robot>(*multi, description, base, isFixed, world.stepSize());
    Added added;
    try
    {
        for (const UrdfSoftPart& part : description.m_softParts)
            added.m_softBodies.push_back(addPart(world, *robot, part, base, name));
    }
    catch (...)
    {
        for (const int body : added.m_softBodies) world.removeBody(body);
        throw;
    }
    world.m_robots.push_back(std::move(robot));
    added.m_robot = int(world.m_robots.size()) - 1;
    return added;
}

Robot& WorldRobots::robot(World& world, int index)
{
    return *world.m_robots.at(std::size_t(index));
}

int WorldRobots::count(const World& world)
{
    return int(world.m_robots.size());
}

}  // namespace bullet_fem::python
