// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "plugin/record/btFemBodyRecord.h"

class btSoftBodySolver;

namespace bullet_fem
{
class Threads;
}

/// The bodies of a solver, by address. Bullet does not report removal from a world, and addresses are reused, so each
/// step compares the records with the world's bodies.
class btFemBodyRegistry
{
public:
    /// The record of a body; null if it is unknown, or if the known body of that address was another one.
    btFemBodyRecord* find(const btSoftBody* body) const;

    /// The record of a body, created if there is none. Throws std::invalid_argument if it is null.
    btFemBodyRecord& record(btSoftBody* body);

    /// Removes the record of a body, if there is one. The pointer may dangle.
    void forget(const btSoftBody* body);

    /// Updates the records to the world's bodies: drops records of bodies that are not in it, and of those whose
    /// address now has another body; creates records for new bodies with tetrahedra; flags bodies that were added twice
    /// or are in another world. `threads` compare the tetrahedra.
    void synchronise(const btAlignedObjectArray<btSoftBody*>& softBodies, const btSoftBodySolver* solver,
                     const bullet_fem::Threads& threads);

    /// Call after callbacks of programs within a step, which may remove and delete soft bodies without notice: removes
    /// those that the world no longer holds from `stepped`. They, and those whose arrays have changed, stand still
    /// until the next step.
    void dropRemoved(const btAlignedObjectArray<btSoftBody*>& held, btAlignedObjectArray<btSoftBody*>& stepped);

    /// True if the address still has the body of the record, with unchanged topology. The body must not be deleted.
    static bool isAsBuilt(const btFemBodyRecord& record);

    /// Moves these records to the front, in this order.
    void putFirst(const std::vector<btFemBodyRecord*>& records);

    const btFemRecords& records() const { return m_records; }

private:
    std::size_t indexOf(const btSoftBody* body) const;
    std::size_t indexOf(const btSoftBody* body, int place) const;
    void numberRecords();
    bool isAnother(std::size_t known, const btSoftBody& body) const;
    void forgetTheDead(const btAlignedObjectArray<btSoftBody*>& softBodies);
    static void lookAgain(btFemBodyRecord& record, bool joinedAsBefore);
    void compareTopologies(const btAlignedObjectArray<btSoftBody*>& softBodies, const bullet_fem::Threads& threads);
    void claim(btFemBodyRecord& record, const void* world, const btSoftBodySolver* solver);

    btFemRecords m_records;                                       // in the order of creation, except for putFirst()
    std::unordered_map<const btSoftBody*, std::size_t> m_number;  // index of each record
    std::vector<unsigned char> m_held;                            // per record: the world being stepped contains it
    std::vector<unsigned char> m_joinedAsBefore;                  // per record: its tetrahedra have their former nodes
    std::vector<int> m_compared;                                  // indices of records
};
