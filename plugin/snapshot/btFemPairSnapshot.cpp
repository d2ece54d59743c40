// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/snapshot/btFemPairSnapshot.h"

#include <algorithm>
#include <map>
#include <utility>

#include "BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h"
#include "BulletCollision/CollisionDispatch/btCollisionDispatcher.h"
#include "BulletCollision/CollisionDispatch/btManifoldResult.h"
#include "BulletSoftBody/btSoftBody.h"
#include "fem/common/message.h"
#include "plugin/dispatch/btFemManifolds.h"
#include "plugin/dispatch/btFemPairAlgorithm.h"
#include "plugin/snapshot/btFemFinite.h"
#include "plugin/snapshot/btFemPrivateState.h"

using namespace bullet_fem;

namespace
{

btCollisionDispatcher& dispatcherOf(btDiscreteDynamicsWorld& world)
{
    auto* dispatcher = dynamic_cast<btCollisionDispatcher*>(world.getDispatcher());
    if (!dispatcher) reject("the world's dispatcher is no btCollisionDispatcher");
    return *dispatcher;
}

int worldIndexOf(const btBroadphaseProxy& proxy)
{
    return static_cast<const btCollisionObject*>(proxy.m_clientObject)->getWorldArrayIndex();
}

// The dispatcher's manifolds in the order that they will have in the next step, which begins with the release of
// predictive ones: Bullet puts the last manifold in the place of a released one.
std::vector<const btPersistentManifold*> manifoldsOfNextStep(btDiscreteDynamicsWorld& world)
{
    btCollisionDispatcher& dispatcher = dispatcherOf(world);
    std::vector<const btPersistentManifold*> manifolds;
    for (int k = 0; k < dispatcher.getNumManifolds(); ++k)
        manifolds.push_back(dispatcher.getManifoldByIndexInternal(k));
    const btAlignedObjectArray<btPersistentManifold*>& predictive = world.*memberOf(btFemPredictiveManifolds{});
    for (int k = 0; k < predictive.size(); ++k)
    {
        const auto at = std::find(manifolds.begin(), manifolds.end(), predictive[k]);
        if (at == manifolds.end()) continue;
        *at = manifolds.back();
        manifolds.pop_back();
    }
    return manifolds;
}

btFemManifoldSnapshot manifoldSnapshotOf(const btPersistentManifold& manifold, const std::pair<int, int>& place)
{
    btFemManifoldSnapshot s;
    s.m_pair = place.first;
    s.m_place = place.second;
    s.m_breakingThreshold = manifold.getContactBreakingThreshold();
    s.m_processingThreshold = manifold.getContactProcessingThreshold();
    for (int k = 0; k < manifold.getNumContacts(); ++k) s.m_points.push_back(manifold.getContactPoint(k));
    return s;
}

bool isFinitePoint(const btManifoldPoint& p)
{
    return btFemFinite::are(p.m_localPointA, p.m_localPointB, p.m_positionWorldOnA, p.m_positionWorldOnB,
                            p.m_normalWorldOnB, p.m_distance1, p.m_combinedFriction, p.m_combinedRollingFriction,
                            p.m_combinedSpinningFriction, p.m_combinedRestitution, p.m_appliedImpulse, p.m_prevRHS,
                            p.m_appliedImpulseLateral1, p.m_appliedImpulseLateral2, p.m_contactMotion1,
                            p.m_contactMotion2, p.m_contactCFM, p.m_contactERP, p.m_frictionCFM,
                            p.m_lateralFrictionDir1, p.m_lateralFrictionDir2);
}

void checkManifold(const btFemManifoldSnapshot& s, std::size_t pairs)
{
    if (s.m_pair < 0 || std::size_t(s.m_pair) >= pairs || s.m_place < 0)
        reject("contacts belong to pair ", s.m_pair, " of ", pairs);
    if (s.m_points.size() > MANIFOLD_CACHE_SIZE) reject("a pair has ", s.m_points.size(), " contact points");
    if (!btFemFinite::are(s.m_breakingThreshold, s.m_processingThreshold) ||
        !std::all_of(s.m_points.begin(), s.m_points.end(), &isFinitePoint))
        reject("a contact point has numbers that are not finite");
}

/// Switches off Bullet's callbacks of contacts while it lives.
class WithoutCallbacks
{
public:
    WithoutCallbacks() = default;
    ~WithoutCallbacks()
    {
        gContactAddedCallback = m_added;
        gContactProcessedCallback = m_processed;
        gContactStartedCallback = m_started;
        gContactEndedCallback = m_ended;
    }
    WithoutCallbacks(const WithoutCallbacks&) = delete;
    WithoutCallbacks& operator=(const WithoutCallbacks&) = delete;

private:
    ContactAddedCallback m_added = std::exchange(gContactAddedCallback, nullptr);
    ContactProcessedCallback m_processed = std::exchange(gContactProcessedCallback, nullptr);
    ContactStartedCallback m_started = std::exchange(gContactStartedCallback, nullptr);
    ContactEndedCallback m_ended = std::exchange(gContactEndedCallback, nullptr);
};

btCollisionObjectWrapper wrapped(const btBroadphaseProxy& proxy)
{
    const auto* object = static_cast<const btCollisionObject*>(proxy.m_clientObject);
    return {nullptr, object->getCollisionShape(), object, object->getWorldTransform(), -1, -1};
}

bool hasSoftBody(const btBroadphasePair& pair)
{
    return btSoftBody::upcast(static_cast<const btCollisionObject*>(pair.m_pProxy0->m_clientObject)) ||
           btSoftBody::upcast(static_cast<const btCollisionObject*>(pair.m_pProxy1->m_clientObject));
}

using Manifolds = std::vector<btPersistentManifold*>;

Manifolds manifoldsOf(const btBroadphasePair& pair)
{
    btManifoldArray all;
    if (pair.m_algorithm) pair.m_algorithm->getAllContactManifolds(all);
    Manifolds manifolds;
    for (int m = 0; m < all.size(); ++m) manifolds.push_back(all[m]);
    return manifolds;
}

// As Bullet's dispatcher does it when a pair is new.
void makeAlgorithm(btBroadphasePair& pair, btDiscreteDynamicsWorld& world)
{
    if (pair.m_algorithm) return;
    const btCollisionObjectWrapper a = wrapped(*pair.m_pProxy0), b = wrapped(*pair.m_pProxy1);
    pair.m_algorithm = dispatcherOf(world).findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
}

// Bullet's algorithms make their manifolds when they search contacts.
Manifolds makeManifolds(const btBroadphasePair& pair, btDiscreteDynamicsWorld& world)
{
    if (!pair.m_algorithm || hasSoftBody(pair)) return {};  // FEM bodies have contacts within a step alone
    const btCollisionObjectWrapper a = wrapped(*pair.m_pProxy0), b = wrapped(*pair.m_pProxy1);
    btManifoldResult result(&a, &b);
    pair.m_algorithm->processCollision(&a, &b, world.getDispatchInfo(), &result);
    return manifoldsOf(pair);
}

/// The manifolds of each pair of the snapshot.
std::vector<Manifolds> makeAlgorithms(const btFemPairsSnapshot& s, btDiscreteDynamicsWorld& world,
                                      const std::vector<btBroadphasePair*>& pairs)
{
    for (const int femPair : s.m_femPairs)
        if (btBroadphasePair* pair = pairs[std::size_t(femPair)]) makeAlgorithm(*pair, world);
    std::vector<Manifolds> manifolds(pairs.size());
    for (std::size_t k = 0; k < pairs.size(); ++k)
    {
        if (!pairs[k] || !s.m_pairs[k].m_hasAlgorithm) continue;
        makeAlgorithm(*pairs[k], world);
        manifolds[k] = makeManifolds(*pairs[k], world);
    }
    return manifolds;
}

// FEM bodies' algorithms begin without a manifold.
btPersistentManifold* shownManifold(const btBroadphasePair* pair)
{
    auto* algorithm = pair ? dynamic_cast<btFemPairAlgorithm*>(pair->m_algorithm) : nullptr;
    return algorithm ? algorithm->begin() : nullptr;
}

void restoreManifold(const btFemManifoldSnapshot& s, btPersistentManifold& manifold)
{
    manifold.setContactBreakingThreshold(s.m_breakingThreshold);
    manifold.setContactProcessingThreshold(s.m_processingThreshold);
    manifold.setNumContacts(int(s.m_points.size()));
    for (std::size_t k = 0; k < s.m_points.size(); ++k)
    {
        manifold.getContactPoint(int(k)) = s.m_points[k];
        manifold.getContactPoint(int(k)).m_userPersistentData = nullptr;
    }
}

bool areOfEqualParts(const btManifoldPoint& a, const btManifoldPoint& b)
{
    return a.m_partId0 == b.m_partId0 && a.m_index0 == b.m_index0 && a.m_partId1 == b.m_partId1 &&
           a.m_index1 == b.m_index1;
}

/// For each saved manifold the one that was made for it, which is then null in `made`; null if there is none. Children
/// of compound shapes that met in the last step, and do no longer, have none: the others are told by their indices.
Manifolds takeMatches(const btFemPairsSnapshot& s, std::vector<Manifolds>& made)
{
    std::vector<std::size_t> saved(made.size(), 0);
    for (const btFemManifoldSnapshot& from : s.m_manifolds) ++saved[std::size_t(from.m_pair)];
    Manifolds matches;
    for (const btFemManifoldSnapshot& from : s.m_manifolds)
    {
        Manifolds& ofPair = made[std::size_t(from.m_pair)];
        const auto isMatch = [&from](const btPersistentManifold* manifold)
        {
            return manifold && manifold->getNumContacts() > 0 && !from.m_points.empty() &&
                   areOfEqualParts(manifold->getContactPoint(0), from.m_points[0]);
        };
        auto at = std::find_if(ofPair.begin(), ofPair.end(), isMatch);
        if (saved[std::size_t(from.m_pair)] == ofPair.size() && std::size_t(from.m_place) < ofPair.size())
            at = ofPair.begin() + from.m_place;
        matches.push_back(at == ofPair.end() ? nullptr : std::exchange(*at, nullptr));
    }
    return matches;
}

// The manifolds in the order that they have after the dispatch of the next step. Pair by pair, it adds those of
// children of compound shapes that meet, and releases those of children that do no longer.
Manifolds inOrder(const btFemPairsSnapshot& s, const Manifolds& restored, const std::vector<Manifolds>& others)
{
    struct Entry
    {
        btPersistentManifold* m_manifold;
        std::size_t m_saved;  // index in the snapshot
    };
    std::vector<Entry> entries;
    for (std::size_t k = 0; k < restored.size(); ++k) entries.push_back({restored[k], k});
    std::vector<std::vector<std::size_t>> missing(others.size());
    for (std::size_t k = 0; k < restored.size(); ++k)
        if (!restored[k]) missing[std::size_t(s.m_manifolds[k].m_pair)].push_back(k);
    for (std::size_t pair = 0; pair < others.size(); ++pair)
    {
        for (btPersistentManifold* manifold : others[pair])
            if (manifold) entries.push_back({manifold, restored.size()});
        for (const std::size_t gone : missing[pair])
        {
            const auto isIt = [gone](const Entry& entry) { return entry.m_saved == gone; };
            *std::find_if(entries.begin(), entries.end(), isIt) = entries.back();
            entries.pop_back();
        }
    }
    Manifolds manifolds;
    for (const Entry& entry : entries) manifolds.push_back(entry.m_manifold);
    return manifolds;
}

// Puts these first, in this order. The others follow in theirs.
void order(btCollisionDispatcher& dispatcher, const Manifolds& first)
{
    btPersistentManifold** all = dispatcher.getInternalManifoldPointer();
    for (std::size_t k = 0; k < first.size(); ++k)
    {
        const int from = first[k]->m_index1a;
        std::swap(all[k], all[from]);
        all[from]->m_index1a = from;
        all[k]->m_index1a = int(k);
    }
}

}  // namespace

btFemPairsSnapshot pairsSnapshotOf(btDiscreteDynamicsWorld& world, const btFemManifolds* shown)
{
    dispatcherOf(world);
    btFemPairsSnapshot s;
    std::map<const btPersistentManifold*, std::pair<int, int>> places;
    std::map<const btCollisionAlgorithm*, int> ofAlgorithm;
    const btBroadphasePairArray& pairs = world.getPairCache()->getOverlappingPairArray();
    for (int k = 0; k < pairs.size(); ++k)
    {
        s.m_pairs.push_back(
            {worldIndexOf(*pairs[k].m_pProxy0), worldIndexOf(*pairs[k].m_pProxy1), pairs[k].m_algorithm != nullptr});
        if (!pairs[k].m_algorithm) continue;
        ofAlgorithm[pairs[k].m_algorithm] = k;
        btManifoldArray all;
        pairs[k].m_algorithm->getAllContactManifolds(all);
        for (int m = 0; m < all.size(); ++m) places[all[m]] = {k, m};
    }
    if (shown)
        for (const btFemPairAlgorithm* algorithm : shown->algorithms())
            if (const auto at = ofAlgorithm.find(algorithm); at != ofAlgorithm.end())
                s.m_femPairs.push_back(at->second);
    for (const btPersistentManifold* manifold : manifoldsOfNextStep(world))
        if (const auto at = places.find(manifold); at != places.end())
            s.m_manifolds.push_back(manifoldSnapshotOf(*manifold, at->second));
    return s;
}

void check(const btFemPairsSnapshot& s, btDiscreteDynamicsWorld& world)
{
    dispatcherOf(world);
    const int objects = world.getNumCollisionObjects();
    for (const btFemPairOfObjects& pair : s.m_pairs)
        if (pair.m_first < 0 || pair.m_first >= objects || pair.m_second < 0 || pair.m_second >= objects ||
            pair.m_first == pair.m_second)
            reject("a pair has the objects ", pair.m_first, " and ", pair.m_second, " of ", objects);
    for (const int femPair : s.m_femPairs)
        if (femPair < 0 || std::size_t(femPair) >= s.m_pairs.size()) reject("it has no pair ", femPair);
    for (const btFemManifoldSnapshot& manifold : s.m_manifolds) checkManifold(manifold, s.m_pairs.size());
}

void removePairs(btDiscreteDynamicsWorld& world)
{
    btCollisionDispatcher& dispatcher = dispatcherOf(world);
    btAlignedObjectArray<btPersistentManifold*>& predictive = world.*memberOf(btFemPredictiveManifolds{});
    for (int k = 0; k < predictive.size(); ++k) dispatcher.releaseManifold(predictive[k]);
    predictive.clear();
    btOverlappingPairCache& cache = *world.getPairCache();
    const WithoutCallbacks quiet;
    while (cache.getNumOverlappingPairs() > 0)
    {
        const btBroadphasePair pair = cache.getOverlappingPairArray()[cache.getNumOverlappingPairs() - 1];
        cache.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, &dispatcher);
    }
}

void restore(const btFemPairsSnapshot& s, btDiscreteDynamicsWorld& world)
{
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    btOverlappingPairCache& cache = *world.getPairCache();
    const WithoutCallbacks quiet;
    const auto proxyAt = [&objects](int index) { return objects[index]->getBroadphaseHandle(); };
    for (const btFemPairOfObjects& pair : s.m_pairs)
        cache.addOverlappingPair(proxyAt(pair.m_first), proxyAt(pair.m_second));
    std::vector<btBroadphasePair*> pairs;  // null where a filter refuses the pair
    for (const btFemPairOfObjects& pair : s.m_pairs)
        pairs.push_back(cache.findPair(proxyAt(pair.m_first), proxyAt(pair.m_second)));
    std::vector<Manifolds> made = makeAlgorithms(s, world, pairs);
    Manifolds restored = takeMatches(s, made);
    for (const Manifolds& ofPair : made)
        for (btPersistentManifold* manifold : ofPair)
            if (manifold) manifold->clearManifold();
    for (std::size_t k = 0; k < restored.size(); ++k)
    {
        const btFemManifoldSnapshot& from = s.m_manifolds[k];
        if (!restored[k]) restored[k] = shownManifold(pairs[std::size_t(from.m_pair)]);
        if (restored[k]) restoreManifold(from, *restored[k]);
    }
    order(dispatcherOf(world), inOrder(s, restored, made));
}
