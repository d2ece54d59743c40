// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemWorldState.h"

#include <functional>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "fem/common/attempt.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/snapshot/btFemBroadphaseSnapshot.h"
#include "plugin/snapshot/btFemEnvelope.h"
#include "plugin/snapshot/btFemObjectSnapshot.h"
#include "plugin/snapshot/btFemPairSnapshot.h"
#include "plugin/snapshot/btFemSnapshot.h"

using namespace bullet_fem;

namespace
{

/// The contents of a world's state.
struct CompleteSnapshot
{
    std::vector<unsigned char> m_fem;  ///< as of saveSnapshot()
    btFemObjectsSnapshot m_objects;
    btFemBroadphaseSnapshot m_broadphase;
    btFemPairsSnapshot m_pairs;
};

template <class Bytes>
void transfer(Bytes& bytes, CompleteSnapshot& s)
{
    bytes(s.m_fem, s.m_objects, s.m_broadphase, s.m_pairs);
}

CompleteSnapshot readComplete(const unsigned char* data, std::size_t size)
{
    CompleteSnapshot snapshot;
    ByteReader bytes = openEnvelope(data, size, btFemContents::world);
    bytes(snapshot);
    if (bytes.left() > 0) reject("it has ", bytes.left(), " bytes too many");
    return snapshot;
}

}  // namespace

bool btFemWorldState::save(btDiscreteDynamicsWorld& world, const btFemSoftBodySolver& fem,
                           std::vector<unsigned char>& buffer, std::string* why)
{
    const bool saved = attemptAs("btFemWorldState::save", why,
                                 [&]
                                 {
                                     CompleteSnapshot snapshot;
                                     saveSnapshot(btFemCoupling::snapshotScope(fem), snapshot.m_fem);
                                     snapshot.m_objects = objectsSnapshotOf(world);
                                     snapshot.m_broadphase = broadphaseSnapshotOf(world);
                                     const auto shown = btFemCoupling::manifolds(fem);
                                     snapshot.m_pairs = pairsSnapshotOf(world, shown.get());
                                     beginEnvelope(buffer, btFemContents::world);
                                     ByteWriter bytes(buffer);
                                     bytes(snapshot);
                                     closeEnvelope(buffer);
                                 });
    if (!saved) buffer.clear();
    return saved;
}

bool btFemWorldState::restore(btDiscreteDynamicsWorld& world, btFemSoftBodySolver& fem, const unsigned char* data,
                              std::size_t size, std::string* why)
{
    return attemptAs("btFemWorldState::restore", why,
                     [&]
                     {
                         const CompleteSnapshot snapshot = readComplete(data, size);
                         check(snapshot.m_objects, world);
                         check(snapshot.m_broadphase, world);
                         check(snapshot.m_pairs, world);
                         const std::function<void()> restoreFem = checkedSnapshot(
                             btFemCoupling::snapshotScope(fem), snapshot.m_fem.data(), snapshot.m_fem.size());
                         removePairs(world);  // nothing is refused from here on
                         ::restore(snapshot.m_objects, world);
                         ::restore(snapshot.m_broadphase, world);
                         ::restore(snapshot.m_pairs, world);
                         restoreFem();
                     });
}
