// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/world.h"

#include <stdexcept>
#include <utility>

#include "python/core/robot.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem::python
{
namespace
{

void removeAnchorsTo(btSoftBody& body, const btRigidBody* rigid)
{
    body.m_collisionDisabledObjects.remove(rigid);
    for (int i = body.m_anchors.size() - 1; i >= 0; --i)
    {
        if (body.m_anchors[i].m_body != rigid) continue;
        body.m_anchors[i].m_node->m_battach = 0;
        body.m_anchors.removeAtIndex(i);
    }
}

}  // namespace

World::World(std::unique_ptr<BulletWorld> bullet, double step, bool factorsInBackground)
    : m_bullet(std::move(bullet)), m_step(step), m_guard(factorsInBackground)
{
    if (m_bullet->scene()) registerScene();
}

World::~World()
{
    if (StepGuard::isLost())  // its threads do not exist in this process, and the destructors would wait for them
    {
        (void)m_bullet.release();
        new BodyTable(std::move(m_bodies));
        new std::vector<JointEntry>(std::move(m_joints));
        new std::vector<std::unique_ptr<Robot>>(std::move(m_robots));
        return;
    }
    for (std::size_t i = 0; i < m_joints.size(); ++i) removeJoint(int(i));
    for (const BodyEntry& body : m_bodies)
    {
        if (body.m_soft && body.m_soft->m_own) m_bullet->remove(*body.m_soft->m_body);
        if (body.m_rigid && body.m_rigid->m_own) m_bullet->world().removeRigidBody(body.m_rigid->m_body);
    }
    m_robots.clear();
    m_bullet.reset();  // before the bodies and their shapes
}

void World::registerScene()
{
    SceneWorld& scene = *m_bullet->scene();
    for (int i = 0; i < scene.rigidCount(); ++i)
    {
        auto entry = std::make_unique<RigidEntry>();
        entry->m_body = &scene.rigid(i);
        const SceneRigidBody& from = scene.description().m_rigidBodies[std::size_t(i)];
        entry->m_shape = std::make_shared<RigidShape>(RigidShape::drawnOnly(from.m_shape));
        m_bodies.append({from.m_name, nullptr, std::move(entry)});
    }
    for (int i = 0; i < scene.softCount(); ++i)
    {
        auto entry = std::make_unique<SoftEntry>();
        entry->m_body = &scene.soft(i);
        const SceneSoftBody& from = scene.description().m_softBodies[std::size_t(i)];
        entry->m_mayBreak = from.m_fracture.m_tension > 0;
        m_bodies.append({from.m_name, std::move(entry), nullptr});
    }
}

int World::add(std::unique_ptr<SoftEntry>&& soft, const std::string& name, int group, int mask)
{
    btSoftBody& body = *soft->m_body;
    m_bullet->add(body, group, mask);
    try
    {
        fem().prepare(&body, btScalar(m_step));
    }
    catch (...)
    {
        m_bullet->remove(body);
        throw;
    }
    return m_bodies.append({name, std::move(soft), nullptr});
}

int World::add(std::unique_ptr<RigidEntry>&& rigid, const std::string& name, int group, int mask)
{
    btRigidBody& body = *rigid->m_body;
    m_bullet->world().addRigidBody(&body, group, mask);
    return m_bodies.append({name, nullptr, std::move(rigid)});
}

int World::add(JointEntry joint, bool bodiesCollide)
{
    m_bullet->world().addConstraint(joint.m_constraint.get(), !bodiesCollide);
    m_joints.push_back(std::move(joint));
    return int(m_joints.size()) - 1;
}

void World::removeBody(int index)
{
    const BodyEntry& entry = m_bodies[index];
    if (entry.m_soft)
    {
        if (!entry.m_soft->m_own) throw std::invalid_argument("bodies of a scene cannot be removed");
        if (entry.m_soft->m_views > 0)
            throw std::runtime_error("a view of the body's nodes exists: delete the array before the body is removed");
        m_bullet->remove(*entry.m_soft->m_body);
        m_bodies.remove(index);
        return;
    }
    const RigidEntry& rigid = m_bodies.rigid(index);
    if (!rigid.m_own) throw std::invalid_argument("bodies of a scene cannot be removed");
    for (std::size_t i = 0; i < m_joints.size(); ++i)
        if (m_joints[i].m_a == index || m_joints[i].m_b == index) removeJoint(int(i));
    for (const BodyEntry& other : m_bodies)
        if (other.m_soft) removeAnchorsTo(*other.m_soft->m_body, rigid.m_body);
    m_bullet->world().removeRigidBody(rigid.m_body);
    m_bodies.remove(index);
}

void World::removeJoint(int index)
{
    JointEntry& joint = m_joints.at(std::size_t(index));
    if (!joint.m_constraint) return;
    m_bullet->world().removeConstraint(joint.m_constraint.get());
    joint.m_constraint.reset();
}

void World::setGravity(const btVector3& gravity)
{
    if (m_bullet->scene()) return m_bullet->scene()->setGravity({gravity.x(), gravity.y(), gravity.z()});
    m_bullet->world().setGravity(gravity);  // also sets that of rigid bodies
    m_bullet->info().m_gravity = gravity;
    for (const BodyEntry& body : m_bodies)
    {
        if (body.m_soft) body.m_soft->m_body->activate();
        if (body.m_rigid) body.m_rigid->m_body->activate();
    }
}

void World::step()
{
    for (const auto& robot : m_robots) robot->addDamping();
    m_bullet->step(m_step);
}

void World::finishStep()
{
    ++m_steps;
    m_bodies.deleteRemoved();
    m_guard.rethrow();
}

void World::setInterest(std::unique_ptr<btFemInterest> interest)
{
    fem().setInterest(interest.get());
    m_interest = std::move(interest);
}

JointEntry& World::joint(int index)
{
    JointEntry& joint = m_joints.at(std::size_t(index));
    if (!joint.m_constraint) throw std::runtime_error("Joint " + std::to_string(index) + " was removed from its world");
    return joint;
}

}  // namespace bullet_fem::python
