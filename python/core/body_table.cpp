// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/body_table.h"

#include <stdexcept>
#include <utility>

namespace bullet_fem::python
{
namespace
{

const btCollisionObject* objectOf(const BodyEntry& entry)
{
    if (entry.m_soft) return entry.m_soft->m_body;
    return entry.m_rigid->m_body;
}

[[noreturn]] void failRemoved(const char* kind, int index)
{
    throw std::runtime_error(std::string(kind) + " " + std::to_string(index) + " was removed from its world");
}

}  // namespace

int BodyTable::append(BodyEntry entry)
{
    m_indices[objectOf(entry)] = size();
    m_entries.push_back(std::move(entry));
    return size() - 1;
}

void BodyTable::remove(int index)
{
    BodyEntry& entry = m_entries[std::size_t(index)];
    m_indices.erase(objectOf(entry));
    m_removed.push_back(std::exchange(entry, {}));
}

SoftEntry& BodyTable::soft(int index) const
{
    const BodyEntry& entry = m_entries.at(std::size_t(index));
    if (!entry.m_soft) failRemoved("SoftBody", index);
    return *entry.m_soft;
}

RigidEntry& BodyTable::rigid(int index) const
{
    const BodyEntry& entry = m_entries.at(std::size_t(index));
    if (!entry.m_rigid) failRemoved("RigidBody", index);
    return *entry.m_rigid;
}

int BodyTable::indexOf(const btCollisionObject* object) const
{
    const auto found = m_indices.find(object);
    return found == m_indices.end() ? -1 : found->second;
}

}  // namespace bullet_fem::python
