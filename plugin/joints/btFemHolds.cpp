// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// What leads and holds nodes: targets, attachments, springs.
#include <stdexcept>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/bodies/btFemBodyRegistry.h"
#include "plugin/btFemCoupling.h"
#include "plugin/joints/btFemAttachments.h"

using namespace bullet_fem;

void btFemSoftBodySolver::setNodeTarget(btSoftBody* body, int node, const btVector3& position)
{
    setTargets(*btFemCoupling::femEntry(*this, body, "setNodeTarget").m_fem, {&node, 1}, &position);
}

void btFemSoftBodySolver::clearNodeTarget(btSoftBody* body, int node)
{
    clearTargets(*btFemCoupling::femEntry(*this, body, "clearNodeTarget").m_fem, {&node, 1});
}

void btFemSoftBodySolver::setNodeTargets(btSoftBody* body, const int* nodes, int count, const btVector3* positions)
{
    setTargets(*btFemCoupling::femEntry(*this, body, "setNodeTargets").m_fem, {nodes, count}, positions);
}

void btFemSoftBodySolver::setNodeTargets(btSoftBody* body, const int* nodes, int count, const btTransform& fromRest)
{
    setTargets(*btFemCoupling::femEntry(*this, body, "setNodeTargets").m_fem, {nodes, count}, fromRest);
}

void btFemSoftBodySolver::clearNodeTargets(btSoftBody* body, const int* nodes, int count)
{
    clearTargets(*btFemCoupling::femEntry(*this, body, "clearNodeTargets").m_fem, {nodes, count});
}

int btFemSoftBodySolver::attachNodes(btSoftBody* a, int nodeA, btSoftBody* b, int nodeB)
{
    const FemSoftBody& other = *btFemCoupling::femEntry(*this, b, "attachNodes").m_fem;
    return attachNode(*btFemCoupling::femEntry(*this, a, "attachNodes").m_fem, nodeA, other,
                      {nodeB, nodeB, nodeB, nodeB}, {1, 0, 0, 0});
}

int btFemSoftBodySolver::attachNodeToTet(btSoftBody* a, int nodeA, btSoftBody* b, int tetB, const btScalar weights[4])
{
    const FemSoftBody& other = *btFemCoupling::femEntry(*this, b, "attachNodeToTet").m_fem;
    if (tetB < 0 || tetB >= b->m_tetras.size() || !weights)
        throw std::invalid_argument("attachNodeToTet: tetrahedron " + std::to_string(tetB) + " is not in [0, " +
                                    std::to_string(b->m_tetras.size()) + "), or the weights are null");
    std::array<int, 4> nodes;
    for (int k = 0; k < 4; ++k) nodes[k] = static_cast<int>(b->m_tetras[tetB].m_n[k] - &b->m_nodes[0]);
    return attachNode(*btFemCoupling::femEntry(*this, a, "attachNodeToTet").m_fem, nodeA, other, nodes,
                      {weights[0], weights[1], weights[2], weights[3]});
}

void btFemSoftBodySolver::detach(btSoftBody* a, int attachment)
{
    detachNode(*btFemCoupling::femEntry(*this, a, "detach").m_fem, attachment);
}

int btFemSoftBodySolver::addSpring(btSoftBody* body, const btFemSpring& spring)
{
    return ::addSpring(*btFemCoupling::femEntry(*this, body, "addSpring").m_fem, spring);
}

void btFemSoftBodySolver::setSpringTarget(btSoftBody* body, int spring, const btVector3& target)
{
    ::setSpringTarget(*btFemCoupling::femEntry(*this, body, "setSpringTarget").m_fem, spring, target);
}

void btFemSoftBodySolver::removeSpring(btSoftBody* body, int spring)
{
    ::removeSpring(*btFemCoupling::femEntry(*this, body, "removeSpring").m_fem, spring);
}
