// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "python/core/arrays.h"
#include "python/core/world.h"

/// Python's objects for bodies and joints: a world, which they keep alive, and an index.
namespace bullet_fem::python
{

using WorldPointer = std::shared_ptr<World>;

struct Handle
{
    WorldPointer m_world;
    int m_index;

    World& world() const { return *m_world; }
    btFemSoftBodySolver& fem() const { return m_world->fem(); }
    bool operator==(const Handle& other) const { return m_world == other.m_world && m_index == other.m_index; }

    /// Throws std::invalid_argument if `other` belongs to another world.
    void mustShareWorld(const Handle& other, const char* name) const
    {
        if (other.m_world != m_world)
            throw std::invalid_argument(std::string(name) + " belongs to another world: both bodies must be of one");
    }
};

struct SoftHandle : Handle
{
    /// Throw if a step does not bear the call, or if the body was removed.
    SoftEntry& reading() const
    {
        m_world->guard().reading();
        return m_world->bodies().soft(m_index);
    }
    SoftEntry& changing() const
    {
        m_world->guard().changing();
        return m_world->bodies().soft(m_index);
    }
    btSoftBody& body() const { return *reading().m_body; }
    int nodeCount() const { return body().m_nodes.size(); }
    int tetCount() const { return body().m_tetras.size(); }
};

struct RigidHandle : Handle
{
    RigidEntry& reading() const
    {
        m_world->guard().reading();
        return m_world->bodies().rigid(m_index);
    }
    RigidEntry& changing() const
    {
        m_world->guard().changing();
        return m_world->bodies().rigid(m_index);
    }
    btRigidBody& body() const { return *reading().m_body; }
};

struct JointHandle : Handle
{
    JointEntry& reading() const
    {
        m_world->guard().reading();
        return m_world->joint(m_index);
    }
    JointEntry& changing() const
    {
        m_world->guard().changing();
        return m_world->joint(m_index);
    }
};

using SoftClass = py::class_<SoftHandle>;
using WorldClass = py::class_<World, WorldPointer>;

/// The body as a SoftHandle or RigidHandle; None if the index is -1 or the body was removed.
py::object bodyOf(const WorldPointer& world, int index);

/// Defines what the name says; in the order of module.cpp.
void bindMaterials(py::module_& module);
void bindMeshes(py::module_& module);
void bindShapes(py::module_& module);
void bindReports(py::module_& module);
WorldClass bindWorld(py::module_& module);
void bindState(WorldClass& world);
void bindStepping(WorldClass& world);
void bindMakers(WorldClass& world);
void bindJoints(py::module_& module, WorldClass& world);
void bindRigidBodies(py::module_& module);
SoftClass bindSoftBodies(py::module_& module);
void bindNodes(SoftClass& body);
void bindStress(SoftClass& body);
void bindContacts(py::module_& module, SoftClass& body, WorldClass& world);
void bindHolds(SoftClass& body);
void bindActuators(SoftClass& body);
void bindBreaking(SoftClass& body, WorldClass& world);
void bindRays(SoftClass& body, WorldClass& world);
void bindPictures(WorldClass& world);
void bindBatch(py::module_& module);
void bindRobots(py::module_& module, WorldClass& world);

}  // namespace bullet_fem::python
