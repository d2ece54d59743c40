// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "btBulletDynamicsCommon.h"
#include "python/core/rigid_shape.h"

namespace bullet_fem::python
{

/// A soft body of a world.
struct SoftEntry
{
    btSoftBody* m_body = nullptr;
    std::unique_ptr<btSoftBody> m_own;                ///< empty if a scene owns it
    btMatrix3x3 m_turn = btMatrix3x3::getIdentity();  ///< from the axes of its mesh to those of its rest shape
    std::map<int, btScalar> m_pinned;                 ///< masses of pinned nodes when they are free [kg]
    int m_views = 0;                                  ///< arrays that share the memory of its nodes
    bool m_mayBreak = false;                          ///< it has a tensile strength, and its nodes may move
};

/// A rigid body of a world.
struct RigidEntry
{
    btRigidBody* m_body = nullptr;
    std::unique_ptr<btRigidBody> m_own;  ///< empty if a scene owns it
    std::shared_ptr<const RigidShape> m_shape;
};

/// A body by its index; one of the two, or none if the body was removed.
struct BodyEntry
{
    std::string m_name;
    std::unique_ptr<SoftEntry> m_soft;
    std::unique_ptr<RigidEntry> m_rigid;
};

/// The bodies of a world by indices that are never used again.
class BodyTable
{
public:
    /// Returns the index.
    int append(BodyEntry entry);
    /// Removes the body; its name is free. It is deleted by deleteRemoved() after the next step, since reports of the
    /// last one have its address, which must not be that of a new body.
    void remove(int index);
    void deleteRemoved() { m_removed.clear(); }

    /// Throw std::runtime_error if the body was removed.
    SoftEntry& soft(int index) const;
    RigidEntry& rigid(int index) const;
    /// Index of a body; -1 if there is none at the address.
    int indexOf(const btCollisionObject* object) const;

    int size() const { return int(m_entries.size()); }
    const BodyEntry& operator[](int index) const { return m_entries[std::size_t(index)]; }
    auto begin() const { return m_entries.begin(); }
    auto end() const { return m_entries.end(); }

private:
    std::vector<BodyEntry> m_entries, m_removed;
    std::unordered_map<const btCollisionObject*, int> m_indices;
};

}  // namespace bullet_fem::python
