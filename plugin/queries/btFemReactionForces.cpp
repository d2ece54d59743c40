// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemReactions.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/body_arrays.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/step/reactions.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"

using namespace bullet_fem;

namespace
{

// Reactions of all held nodes; null if unknown.
const std::vector<NodeReaction>* reactionsOf(const btFemSoftBodySolver& solver, const btSoftBody* body)
{
    const btFemBodyRecord* record = body ? btFemCoupling::record(solver, *body) : nullptr;
    if (!record || !record->isFem() || !arraysAsSetUp(record->fem())) return nullptr;
    if ((record->m_reports.m_step.m_flags & BT_FEM_BAD_STEP) != 0) return nullptr;
    return reactions(record->fem().m_body);
}

// Null at nodes that are free.
const NodeReaction* reactionAt(const std::vector<NodeReaction>& all, int node)
{
    const auto found = std::lower_bound(all.begin(), all.end(), node,
                                        [](const NodeReaction& reaction, int i) { return reaction.m_node < i; });
    return found != all.end() && found->m_node == node ? &*found : nullptr;
}

/// A sum in double precision.
class ReactionSum
{
public:
    explicit ReactionSum(const btVector3& about) : m_about(vec3(about)) {}

    void add(const Vec3& point, const Vec3& force)
    {
        m_force += force;
        m_moment += cross(point - m_about, force);
        ++m_count;
    }
    void addMoment(const Vec3& moment) { m_moment += moment, ++m_count; }

    btFemReaction reaction() const
    {
        btFemReaction sum;
        sum.m_force = bulletVector(m_force);
        sum.m_moment = bulletVector(m_moment);
        sum.m_count = m_count;
        return sum;
    }

private:
    Vec3 m_about, m_force, m_moment;
    int m_count = 0;
};

}  // namespace

btVector3 btFemSoftBodySolver::reactionForce(const btSoftBody* body, int node) const
{
    const std::vector<NodeReaction>* all = reactionsOf(*this, body);
    const NodeReaction* found = all ? reactionAt(*all, node) : nullptr;
    return found ? bulletVector(found->m_force) : btVector3(0, 0, 0);
}

bool btFemSoftBodySolver::getReactionForces(const btSoftBody* body, btAlignedObjectArray<btVector3>& perNode) const
{
    const std::vector<NodeReaction>* all = reactionsOf(*this, body);
    perNode.resize(all ? body->m_nodes.size() : 0);
    for (int i = 0; i < perNode.size(); ++i) perNode[i].setZero();
    if (!all) return false;
    for (const NodeReaction& reaction : *all) perNode[reaction.m_node] = bulletVector(reaction.m_force);
    return true;
}

btFemReaction btFemSoftBodySolver::reaction(const btSoftBody* body, const int* nodes, int count,
                                            const btVector3& about) const
{
    const std::vector<NodeReaction>* all = reactionsOf(*this, body);
    ReactionSum sum(about);
    for (int k = 0; all && nodes && k < count; ++k)
        if (const NodeReaction* found = reactionAt(*all, nodes[k])) sum.add(found->m_point, found->m_force);
    return sum.reaction();
}

btFemReaction btFemSoftBodySolver::reaction(const btSoftBody* body, const btVector3& about) const
{
    const std::vector<NodeReaction>* all = reactionsOf(*this, body);
    ReactionSum sum(about);
    if (all)
        for (const NodeReaction& reaction : *all) sum.add(reaction.m_point, reaction.m_force);
    return sum.reaction();
}

btFemReaction btFemSoftBodySolver::anchorReaction(const btSoftBody* body, const btCollisionObject* object,
                                                  const btVector3& about) const
{
    const btFemBodyRecord* record = body ? btFemCoupling::record(*this, *body) : nullptr;
    ReactionSum sum(about);
    if (!record || !(record->m_work.m_lastStep > 0)) return sum.reaction();
    const btAlignedObjectArray<btFemAnchorReport>& anchors = record->m_reports.m_anchors;
    for (int k = 0; k < anchors.size(); ++k)
    {
        if (anchors[k].m_object != object) continue;
        const Vec3 force = (1 / record->m_work.m_lastStep) * vec3(anchors[k].m_impulse);
        if (anchors[k].m_kind == btFemHold::angularJoint)
            sum.addMoment(force);
        else
            sum.add(vec3(anchors[k].m_point), force);
    }
    return sum.reaction();
}
