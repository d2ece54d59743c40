// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>

#include "BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemHelpers.h"

namespace
{

// True if every render node has the data that Bullet requires: weights, and three parents with a distance from their
// plane, or four, or none.
bool isEmbedded(const btSoftBody& body)
{
    const int count = body.m_renderNodes.size();
    const bool onFaces = body.m_z.size() > 0;
    if (body.m_renderNodesParents.size() != count || body.m_renderNodesInterpolationWeights.size() != count ||
        (onFaces && body.m_z.size() != count))
        return false;
    for (int v = 0; v < count; ++v)
    {
        const int parents = body.m_renderNodesParents[v].size();
        if (onFaces ? parents < 3 : parents > 0 && parents < 4) return false;
    }
    return true;
}

/// Bullet does not publish the difference between its clock and the last step.
struct WorldClock : btDiscreteDynamicsWorld
{
    static btScalar localTime(const btDiscreteDynamicsWorld& world) { return world.*(&WorldClock::m_localTime); }
    static btScalar fixedStep(const btDiscreteDynamicsWorld& world) { return world.*(&WorldClock::m_fixedTimeStep); }
};

/// Positions at which nodes are drawn.
class DrawnNodes
{
public:
    DrawnNodes(const btSoftBody& body, btScalar fraction)
    {
        if (!body.isActive() || !body.getBroadphaseHandle() || !(fraction >= 0 || fraction < 0)) return;
        m_back = std::clamp(-fraction, btScalar(0), btScalar(1));
        m_ahead = std::clamp(fraction, btScalar(0), btScalar(1)) * body.m_sst.sdt;
    }

    btVector3 at(const btSoftBody::Node& node) const
    {
        if (m_back > 0) return node.m_x + m_back * (node.m_q - node.m_x);
        return m_ahead > 0 ? node.m_x + m_ahead * node.m_v : node.m_x;
    }

private:
    btScalar m_back = 0;   // share of the last step
    btScalar m_ahead = 0;  // [s]
};

// As btSoftBody::interpolateRenderMesh() does, which writes to the body.
btVector3 embeddedPosition(const btSoftBody& body, int vertex, const DrawnNodes& nodes)
{
    const auto& parents = body.m_renderNodesParents[vertex];
    const btVector4& weights = body.m_renderNodesInterpolationWeights[vertex];
    const bool onFace = body.m_z.size() > 0;
    btVector3 x[4], sum(0, 0, 0);
    for (int a = 0; a < (onFace ? 3 : 4) && parents.size() > 0; ++a)
    {
        x[a] = nodes.at(*parents[a]);
        sum += x[a] * weights[a];
    }
    return onFace ? sum + body.m_z[vertex] * btCross(x[1] - x[0], x[2] - x[0]).normalized() : sum;
}

}  // namespace

void btFemHelpers::updateEmbeddedSurface(btSoftBody* body)
{
    if (body && body->m_renderNodes.size() > 0 && isEmbedded(*body)) body->interpolateRenderMesh();
}

btScalar btFemHelpers::interpolationFraction(const btDiscreteDynamicsWorld& world)
{
    const btScalar time = WorldClock::localTime(world), step = WorldClock::fixedStep(world);
    if (step > 0) return world.getLatencyMotionStateInterpolation() ? time / step - 1 : time / step;
    return btFuzzyZero(time) ? btScalar(0) : btScalar(1);
}

bool btFemHelpers::interpolateNodes(const btSoftBody* body, btScalar fraction, btAlignedObjectArray<btVector3>& out)
{
    out.resize(body ? body->m_nodes.size() : 0);
    if (!body) return false;
    const DrawnNodes nodes(*body, fraction);
    for (int i = 0; i < out.size(); ++i) out[i] = nodes.at(body->m_nodes[i]);
    return true;
}

bool btFemHelpers::interpolateEmbeddedSurface(const btSoftBody* body, btScalar fraction,
                                              btAlignedObjectArray<btVector3>& out)
{
    out.resize(body ? body->m_renderNodes.size() : 0);
    if (out.size() == 0) return false;
    const bool embedded = isEmbedded(*body);
    const DrawnNodes nodes(*body, fraction);
    for (int v = 0; v < out.size(); ++v)
        out[v] = embedded ? embeddedPosition(*body, v, nodes) : body->m_renderNodes[v].m_x;
    return true;
}
