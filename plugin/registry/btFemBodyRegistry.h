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

/// The bodies of a solver, by address. Removal from a world is silent and addresses are reused, so every step compares
/// what is known with what the world holds.
class btFemBodyRegistry
{
public:
    /// Null if it is not known, be it that a body which is known had its address before.
    btFemBodyRecord* find(const btSoftBody* body) const;

    /// The record of a body, made if there is none. Throws std::invalid_argument on null.
    btFemBodyRecord& record(btSoftBody* body);

    void forget(const btSoftBody* body);

    /// Makes the records those of the world's bodies: drops records of bodies that left it or never came, and those
    /// whose address now holds another body; makes records for new ones with tetrahedra; flags bodies added twice or
    /// elsewhere. `threads` compare their tetrahedra with what is known.
    void synchronise(const btAlignedObjectArray<btSoftBody*>& softBodies, const btSoftBodySolver* solver,
                     const bullet_fem::Threads& threads);

    /// True if the address still holds the body that the record was made for, uncut. The body must not be deleted.
    static bool isAsBuilt(const btFemBodyRecord& record);

    /// Puts some of the records before all others, in this order.
    void putFirst(const std::vector<btFemBodyRecord*>& records);

    const btFemRecords& records() const { return m_records; }

private:
    std::size_t indexOf(const btSoftBody* body) const;
    void numberRecords();
    bool isAnother(std::size_t known, const btSoftBody& body) const;
    void forgetTheDead(const btAlignedObjectArray<btSoftBody*>& softBodies);
    static void lookAgain(btFemBodyRecord& record, bool joinedAsBefore);
    void compareTopologies(const btAlignedObjectArray<btSoftBody*>& softBodies, const bullet_fem::Threads& threads);
    void claim(btFemBodyRecord& record, const void* world, const btSoftBodySolver* solver);

    btFemRecords m_records;                                       // in the order in which they became known
    std::unordered_map<const btSoftBody*, std::size_t> m_number;  // of every record
    std::vector<unsigned char> m_held;                            // per record: the world being stepped holds it
    std::vector<unsigned char> m_joinedAsBefore;  // likewise: its tetrahedra join the nodes that they did
    std::vector<int> m_compared;                  // records
};
