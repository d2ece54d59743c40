// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/snapshot/btFemBroadphaseSnapshot.h"

#include <algorithm>
#include <functional>
#include <new>

#include "LinearMath/btAlignedAllocator.h"
#include "fem/common/message.h"
#include "plugin/snapshot/btFemFinite.h"

using namespace bullet_fem;

namespace
{

constexpr int kStages = btDbvtBroadphase::STAGECOUNT + 1;

btDbvtProxy* proxyOf(btDiscreteDynamicsWorld& world, int object)
{
    return static_cast<btDbvtProxy*>(world.getCollisionObjectArray()[object]->getBroadphaseHandle());
}

int objectIndexOf(const btDiscreteDynamicsWorld& world, const btBroadphaseProxy& proxy)
{
    const auto* object = static_cast<const btCollisionObject*>(proxy.m_clientObject);
    const int index = object->getWorldArrayIndex();
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    if (index < 0 || index >= objects.size() || objects[index] != object || object->getBroadphaseHandle() != &proxy)
        reject("its broad phase has an object that is not in the world, or an object twice; remove it");
    return index;
}

void collectNodes(const btDbvtNode* node, std::vector<const btDbvtNode*>& nodes)
{
    std::vector<const btDbvtNode*> left;
    if (node) left.push_back(node);
    while (!left.empty())
    {
        node = left.back();
        left.pop_back();
        nodes.push_back(node);
        if (node->isleaf()) continue;
        left.push_back(node->childs[1]);
        left.push_back(node->childs[0]);
    }
}

btFemTreeSnapshot snapshotOf(const btDbvt& tree, const btDiscreteDynamicsWorld& world)
{
    std::vector<const btDbvtNode*> nodes;
    collectNodes(tree.m_root, nodes);
    std::vector<const btDbvtNode*> sorted = nodes;
    if (tree.m_free) sorted.push_back(tree.m_free);
    std::sort(sorted.begin(), sorted.end(), std::less<const btDbvtNode*>());
    const auto rankOf = [&sorted](const btDbvtNode* node) {
        return int(std::lower_bound(sorted.begin(), sorted.end(), node, std::less<const btDbvtNode*>()) -
                   sorted.begin());
    };
    btFemTreeSnapshot s;
    for (const btDbvtNode* node : nodes)
        s.m_nodes.push_back({node->volume.Mins(), node->volume.Maxs(),
                             node->isleaf() ? objectIndexOf(world, *static_cast<btDbvtProxy*>(node->data)) : -1,
                             rankOf(node)});
    if (tree.m_free) s.m_freeRank = rankOf(tree.m_free);
    s.m_lookAhead = tree.m_lkhd;
    s.m_path = tree.m_opath;
    return s;
}

/// Marks indices, and refuses those that are none, or that come twice.
class Once
{
public:
    Once(std::size_t count, const char* name) : m_found(count, false), m_name(name) {}

    void add(int index)
    {
        if (index < 0 || std::size_t(index) >= m_found.size() || m_found[std::size_t(index)])
            reject(m_name, " ", index, " is none, or comes twice");
        m_found[std::size_t(index)] = true;
    }

    bool isComplete() const { return std::find(m_found.begin(), m_found.end(), false) == m_found.end(); }

private:
    std::vector<bool> m_found;
    const char* m_name;
};

// Leaves and inner nodes in this order must make one tree.
void checkTree(const btFemTreeSnapshot& s, Once& objects)
{
    Once ranks(s.m_nodes.size() + (s.m_freeRank >= 0 ? 1 : 0), "the rank");
    long open = s.m_nodes.empty() ? 0 : 1;  // nodes that must still come
    for (const btFemTreeNodeSnapshot& node : s.m_nodes)
    {
        if (open == 0) reject("a tree of its broad phase has nodes without a parent");
        open += node.m_object >= 0 ? -1 : 1;
        if (node.m_object >= 0) objects.add(node.m_object);
        ranks.add(node.m_rank);
        if (!btFemFinite::are(node.m_low, node.m_high)) reject("bounds of its broad phase are not finite");
    }
    if (open != 0) reject("a tree of its broad phase has too few nodes");
    if (s.m_freeRank >= 0) ranks.add(s.m_freeRank);
}

void restoreTree(const btFemTreeSnapshot& s, btDiscreteDynamicsWorld& world, btDbvt& tree)
{
    tree.clear();
    std::vector<btDbvtNode*> sorted(s.m_nodes.size() + (s.m_freeRank >= 0 ? 1 : 0));
    for (btDbvtNode*& node : sorted) node = new (btAlignedAlloc(sizeof(btDbvtNode), 16)) btDbvtNode();
    std::sort(sorted.begin(), sorted.end(), std::less<btDbvtNode*>());
    std::vector<btDbvtNode*> parents;  // whose children are not complete
    tree.m_leaves = 0;
    for (const btFemTreeNodeSnapshot& from : s.m_nodes)
    {
        btDbvtNode* node = sorted[std::size_t(from.m_rank)];
        node->volume = btDbvtVolume::FromMM(from.m_low, from.m_high);
        node->parent = parents.empty() ? nullptr : parents.back();
        node->childs[0] = node->childs[1] = nullptr;
        if (!node->parent)
            tree.m_root = node;
        else if (node->parent->childs[0])
        {
            node->parent->childs[1] = node;
            parents.pop_back();
        }
        else
            node->parent->childs[0] = node;
        if (from.m_object < 0)
        {
            parents.push_back(node);
            continue;
        }
        ++tree.m_leaves;
        btDbvtProxy* proxy = proxyOf(world, from.m_object);
        node->data = proxy;
        proxy->leaf = node;
    }
    if (s.m_freeRank >= 0) tree.m_free = sorted[std::size_t(s.m_freeRank)];
    tree.m_lkhd = s.m_lookAhead;
    tree.m_opath = s.m_path;
}

void restoreStages(const btFemBroadphaseSnapshot& s, btDiscreteDynamicsWorld& world, btDbvtBroadphase& trees)
{
    for (int stage = 0; stage < kStages; ++stage)
    {
        btDbvtProxy* before = nullptr;
        trees.m_stageRoots[stage] = nullptr;
        for (const int object : s.m_stages[std::size_t(stage)])
        {
            btDbvtProxy* proxy = proxyOf(world, object);
            proxy->stage = stage;
            proxy->links[0] = before;
            proxy->links[1] = nullptr;
            (before ? before->links[1] : trees.m_stageRoots[stage]) = proxy;
            before = proxy;
        }
    }
}

}  // namespace

btDbvtBroadphase& treesOf(btDiscreteDynamicsWorld& world)
{
    auto* trees = dynamic_cast<btDbvtBroadphase*>(world.getBroadphase());
    if (!trees) reject("the world's broad phase is no btDbvtBroadphase");
    return *trees;
}

btFemBroadphaseSnapshot broadphaseSnapshotOf(btDiscreteDynamicsWorld& world)
{
    const btDbvtBroadphase& trees = treesOf(world);
    btFemBroadphaseSnapshot s;
    for (int k = 0; k < world.getNumCollisionObjects(); ++k)
    {
        const btDbvtProxy* proxy = proxyOf(world, k);
        if (!proxy) reject("object ", k, " of the world is not in its broad phase; make a step first, or remove it");
        s.m_bounds.push_back({proxy->m_aabbMin, proxy->m_aabbMax});
    }
    for (int set = 0; set < 2; ++set) s.m_trees[std::size_t(set)] = snapshotOf(trees.m_sets[set], world);
    for (int stage = 0; stage < kStages; ++stage)
        for (const btDbvtProxy* proxy = trees.m_stageRoots[stage]; proxy; proxy = proxy->links[1])
            s.m_stages[std::size_t(stage)].push_back(objectIndexOf(world, *proxy));
    s.m_stage = trees.m_stageCurrent;
    s.m_newPairs = trees.m_newpairs;
    s.m_fixedLeft = trees.m_fixedleft;
    s.m_parseId = trees.m_pid;
    s.m_cleanUpAt = trees.m_cid;
    s.m_lastId = trees.m_gid;
    s.m_updateCalls = trees.m_updates_call;
    s.m_updatesDone = trees.m_updates_done;
    s.m_updateRatio = trees.m_updates_ratio;
    s.m_needsCleanUp = trees.m_needcleanup;
    return s;
}

void check(const btFemBroadphaseSnapshot& s, btDiscreteDynamicsWorld& world)
{
    treesOf(world);
    const std::size_t count = std::size_t(world.getNumCollisionObjects());
    if (s.m_bounds.size() != count) reject("its broad phase has ", s.m_bounds.size(), " objects, the world ", count);
    for (std::size_t k = 0; k < count; ++k)
    {
        const btDbvtProxy* proxy = proxyOf(world, int(k));
        if (!proxy) reject("object ", k, " of the world is not in its broad phase");
        if (proxy->m_uniqueId > s.m_lastId)
            reject("its last broad phase id is ", s.m_lastId, ", and an object has more");
        if (!btFemFinite::are(s.m_bounds[k].m_low, s.m_bounds[k].m_high)) reject("bounds of an object are not finite");
    }
    Once inTrees(count, "the object of a tree"), inStages(count, "the object of a stage");
    for (const btFemTreeSnapshot& tree : s.m_trees) checkTree(tree, inTrees);
    for (const std::vector<int>& stage : s.m_stages)
        for (const int object : stage) inStages.add(object);
    if (!inTrees.isComplete() || !inStages.isComplete()) reject("its broad phase lacks objects of the world");
    const std::size_t fixed = s.m_stages[btDbvtBroadphase::STAGECOUNT].size();
    for (const int object : s.m_stages[btDbvtBroadphase::STAGECOUNT])
    {
        const auto isIt = [object](const btFemTreeNodeSnapshot& node) { return node.m_object == object; };
        const auto& nodes = s.m_trees[btDbvtBroadphase::FIXED_SET].m_nodes;
        if (std::none_of(nodes.begin(), nodes.end(), isIt)) reject("an object is in the wrong tree");
    }
    if (s.m_trees[btDbvtBroadphase::FIXED_SET].m_nodes.size() != (fixed > 0 ? 2 * fixed - 1 : 0))
        reject("an object is in the wrong tree");
    if (s.m_stage < 0 || s.m_stage >= btDbvtBroadphase::STAGECOUNT || s.m_cleanUpAt < 0 || s.m_newPairs < 0 ||
        s.m_fixedLeft < 0)
        reject("a counter of its broad phase is out of range");
}

void restore(const btFemBroadphaseSnapshot& s, btDiscreteDynamicsWorld& world)
{
    btDbvtBroadphase& trees = treesOf(world);
    for (std::size_t k = 0; k < s.m_bounds.size(); ++k)
    {
        proxyOf(world, int(k))->m_aabbMin = s.m_bounds[k].m_low;
        proxyOf(world, int(k))->m_aabbMax = s.m_bounds[k].m_high;
    }
    for (int set = 0; set < 2; ++set) restoreTree(s.m_trees[std::size_t(set)], world, trees.m_sets[set]);
    restoreStages(s, world, trees);
    trees.m_stageCurrent = s.m_stage;
    trees.m_newpairs = s.m_newPairs;
    trees.m_fixedleft = s.m_fixedLeft;
    trees.m_pid = s.m_parseId;
    trees.m_cid = s.m_cleanUpAt;
    trees.m_gid = s.m_lastId;
    trees.m_updates_call = s.m_updateCalls;
    trees.m_updates_done = s.m_updatesDone;
    trees.m_updates_ratio = s.m_updateRatio;
    trees.m_needcleanup = s.m_needsCleanUp;
}
