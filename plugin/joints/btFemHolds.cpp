// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// btFemSoftBodySolver: node targets, attachments and springs.
#include <stdexcept>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/contact/cloth/cloth_surface.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "fem/common/attempt.h"
#include "plugin/joints/btFemAttachments.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"

using namespace bullet_fem;

bool btFemSoftBodySolver::setNodeTarget(btSoftBody* body, int node, const btVector3& position, std::string* why)
{
    return attempt(why,
                   [&] {
                       setTargets(btFemCoupling::femRecord(*this, body, "setNodeTarget").fem(), {&node, 1}, &position);
                   });
}

bool btFemSoftBodySolver::clearNodeTarget(btSoftBody* body, int node, std::string* why)
{
    return attempt(why,
                   [&] {
                       clearTargets(btFemCoupling::femRecord(*this, body, "clearNodeTarget").fem(), {&node, 1});
                   });
}

bool btFemSoftBodySolver::setNodeTargets(btSoftBody* body, const int* nodes, int count, const btVector3* positions,
                                         std::string* why)
{
    return attempt(
        why,
        [&] {
            setTargets(btFemCoupling::femRecord(*this, body, "setNodeTargets").fem(), {nodes, count}, positions);
        });
}

bool btFemSoftBodySolver::setNodeTargets(btSoftBody* body, const int* nodes, int count, const btTransform& fromRest,
                                         std::string* why)
{
    return attempt(
        why,
        [&] {
            setTargets(btFemCoupling::femRecord(*this, body, "setNodeTargets").fem(), {nodes, count}, fromRest);
        });
}

bool btFemSoftBodySolver::clearNodeTargets(btSoftBody* body, const int* nodes, int count, std::string* why)
{
    return attempt(why,
                   [&] {
                       clearTargets(btFemCoupling::femRecord(*this, body, "clearNodeTargets").fem(), {nodes, count});
                   });
}

int btFemSoftBodySolver::attachNodes(btSoftBody* a, int nodeA, btSoftBody* b, int nodeB, std::string* why)
{
    return attemptValue(why,
                        [&]
                        {
                            FemSoftBody& other = btFemCoupling::femRecord(*this, b, "attachNodes").fem();
                            if (a && isCloth(*a))
                                return attachCloth(other, {nodeB, nodeB, nodeB, nodeB}, {1, 0, 0, 0}, *a, nodeA);
                            return attachNode(btFemCoupling::femRecord(*this, a, "attachNodes").fem(), nodeA, other,
                                              {nodeB, nodeB, nodeB, nodeB}, {1, 0, 0, 0});
                        });
}

int btFemSoftBodySolver::attachNodeToTet(btSoftBody* a, int nodeA, btSoftBody* b, int tetB, const btScalar weights[4],
                                         std::string* why)
{
    return attemptValue(
        why,
        [&]
        {
            FemSoftBody& other = btFemCoupling::femRecord(*this, b, "attachNodeToTet").fem();
            if (tetB < 0 || tetB >= b->m_tetras.size() || !weights)
                throw std::invalid_argument("attachNodeToTet: tetrahedron " + std::to_string(tetB) + " is not in [0, " +
                                            std::to_string(b->m_tetras.size()) + "), or the weights are null");
            std::array<int, 4> nodes;
            for (int k = 0; k < 4; ++k) nodes[k] = static_cast<int>(b->m_tetras[tetB].m_n[k] - &b->m_nodes[0]);
            const std::array<double, 4> w = {weights[0], weights[1], weights[2], weights[3]};
            if (a && isCloth(*a)) return attachCloth(other, nodes, w, *a, nodeA);
            return attachNode(btFemCoupling::femRecord(*this, a, "attachNodeToTet").fem(), nodeA, other, nodes, w);
        });
}

bool btFemSoftBodySolver::detach(btSoftBody* a, int attachment, std::string* why)
{
    return attempt(why, [&] { detachNode(btFemCoupling::femRecord(*this, a, "detach").fem(), attachment); });
}

int btFemSoftBodySolver::addSpring(btSoftBody* body, const btFemSpring& spring, std::string* why)
{
    return attemptValue(why,
                        [&] { return ::addSpring(btFemCoupling::femRecord(*this, body, "addSpring").fem(), spring); });
}

bool btFemSoftBodySolver::setSpringTarget(btSoftBody* body, int spring, const btVector3& target, std::string* why)
{
    return attempt(
        why,
        [&] { ::setSpringTarget(btFemCoupling::femRecord(*this, body, "setSpringTarget").fem(), spring, target); });
}

bool btFemSoftBodySolver::removeSpring(btSoftBody* body, int spring, std::string* why)
{
    return attempt(why, [&] { ::removeSpring(btFemCoupling::femRecord(*this, body, "removeSpring").fem(), spring); });
}
