// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/body_arrays.h"

#include <cstdint>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/geometry/limits.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

/// Maps pointers into one array to equal indices of another.
class Shift
{
public:
    Shift(const btSoftBody::Node* from, std::size_t count, btSoftBody::Node* to)
        : m_from(address(from)), m_end(m_from + count * sizeof(btSoftBody::Node)), m_to(to)
    {
    }

    template <class Pointer>
    void apply(Pointer& node) const
    {
        const std::uintptr_t at = address(node);
        if (at >= m_from && at < m_end) node = m_to + (at - m_from) / sizeof(btSoftBody::Node);
    }

private:
    static std::uintptr_t address(const btSoftBody::Node* node) { return reinterpret_cast<std::uintptr_t>(node); }

    std::uintptr_t m_from, m_end;
    btSoftBody::Node* m_to;
};

int nodeCountOf(const FemSoftBody& fem)
{
    return static_cast<int>(fem.m_written.m_x.size());
}

bool hasAsManyAsSetUp(const FemSoftBody& fem)
{
    const btSoftBody& soft = *fem.m_softBody;
    return soft.m_nodes.size() == nodeCountOf(fem) && soft.m_tetras.size() == fem.m_body.m_model->mesh().tetCount();
}

}  // namespace

void followNodes(FemSoftBody& fem)
{
    btSoftBody& soft = *fem.m_softBody;
    if (soft.m_nodes.size() == 0 || &soft.m_nodes[0] == fem.m_setUp.m_firstNode) return;
    const Shift shift(fem.m_setUp.m_firstNode, nodeCountOf(fem), &soft.m_nodes[0]);
    fem.m_setUp.m_firstNode = &soft.m_nodes[0];
    for (int e = 0; e < soft.m_tetras.size(); ++e)
        for (btSoftBody::Node*& node : soft.m_tetras[e].m_n) shift.apply(node);
    for (int i = 0; i < soft.m_renderNodesParents.size(); ++i)
        for (int k = 0; k < soft.m_renderNodesParents[i].size(); ++k) shift.apply(soft.m_renderNodesParents[i][k]);
    for (int c = 0; c < soft.m_clusters.size(); ++c)
        for (int k = 0; k < soft.m_clusters[c]->m_nodes.size(); ++k) shift.apply(soft.m_clusters[c]->m_nodes[k]);
    for (int k = 0; k < soft.m_deformableAnchors.size(); ++k) shift.apply(soft.m_deformableAnchors[k].m_node);
}

bool arraysAsSetUp(const FemSoftBody& fem)
{
    return hasAsManyAsSetUp(fem) && &fem.m_softBody->m_nodes[0] == fem.m_setUp.m_firstNode;
}

bool topologyAsSetUp(const FemSoftBody& fem)
{
    return hasAsManyAsSetUp(fem) && fem.m_setUp.m_topology.match(*fem.m_softBody);
}

bool topologyInTurnAsSetUp(FemSoftBody& fem)
{
    return hasAsManyAsSetUp(fem) && fem.m_setUp.m_topology.matchInTurn(*fem.m_softBody);
}

bool hasUsableNodes(const btSoftBody& body)
{
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (!isBelow(kFarthest, vec3(body.m_nodes[i].m_x))) return false;
    return true;
}

}  // namespace bullet_fem
