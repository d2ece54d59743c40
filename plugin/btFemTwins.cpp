// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// For engines without exceptions.
#include <string>

#include "bullet_fem/btFemDebugDraw.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"
#include "plugin/btFemAttempt.h"

bool btFemSoftBodySolver::setMaterial(btSoftBody* body, const btFemMaterial& material, std::string* why)
{
    return succeeds([&] { setMaterial(body, material); }, why);
}

bool btFemSoftBodySolver::setDetail(btSoftBody* body, btFemDetail detail, std::string* why)
{
    return succeeds([&] { setDetail(body, detail); }, why);
}

bool btFemSoftBodySolver::setInterest(btFemInterest* interest, const btFemDetailPolicy& policy, std::string* why)
{
    return succeeds([&] { setInterest(interest, policy); }, why);
}

bool btFemSoftBodySolver::prepare(btSoftBody* body, btScalar fixedTimeStep, std::string* why)
{
    return succeeds([&] { prepare(body, fixedTimeStep); }, why);
}

bool btFemSoftBodySolver::useBaked(btSoftBody* body, const bullet_fem::BakedBody& baked, std::string* why)
{
    return succeeds([&] { useBaked(body, baked); }, why);
}

bool btFemSoftBodySolver::refactor(btSoftBody* body, std::string* why)
{
    return succeeds([&] { refactor(body); }, why);
}

bool btFemSoftBodySolver::setNodeTarget(btSoftBody* body, int node, const btVector3& position, std::string* why)
{
    return succeeds([&] { setNodeTarget(body, node, position); }, why);
}

bool btFemSoftBodySolver::clearNodeTarget(btSoftBody* body, int node, std::string* why)
{
    return succeeds([&] { clearNodeTarget(body, node); }, why);
}

bool btFemSoftBodySolver::setNodeTargets(btSoftBody* body, const int* nodes, int count, const btVector3* positions,
                                         std::string* why)
{
    return succeeds([&] { setNodeTargets(body, nodes, count, positions); }, why);
}

bool btFemSoftBodySolver::setNodeTargets(btSoftBody* body, const int* nodes, int count, const btTransform& fromRest,
                                         std::string* why)
{
    return succeeds([&] { setNodeTargets(body, nodes, count, fromRest); }, why);
}

bool btFemSoftBodySolver::clearNodeTargets(btSoftBody* body, const int* nodes, int count, std::string* why)
{
    return succeeds([&] { clearNodeTargets(body, nodes, count); }, why);
}

int btFemSoftBodySolver::attachNodes(btSoftBody* a, int nodeA, btSoftBody* b, int nodeB, std::string* why)
{
    int handle = 0;
    succeeds([&] { handle = attachNodes(a, nodeA, b, nodeB); }, why);
    return handle;
}

int btFemSoftBodySolver::attachNodeToTet(btSoftBody* a, int nodeA, btSoftBody* b, int tetB, const btScalar weights[4],
                                         std::string* why)
{
    int handle = 0;
    succeeds([&] { handle = attachNodeToTet(a, nodeA, b, tetB, weights); }, why);
    return handle;
}

bool btFemSoftBodySolver::detach(btSoftBody* a, int attachment, std::string* why)
{
    return succeeds([&] { detach(a, attachment); }, why);
}

int btFemSoftBodySolver::addSpring(btSoftBody* body, const btFemSpring& spring, std::string* why)
{
    int handle = 0;
    succeeds([&] { handle = addSpring(body, spring); }, why);
    return handle;
}

bool btFemSoftBodySolver::setSpringTarget(btSoftBody* body, int spring, const btVector3& target, std::string* why)
{
    return succeeds([&] { setSpringTarget(body, spring, target); }, why);
}

bool btFemSoftBodySolver::removeSpring(btSoftBody* body, int spring, std::string* why)
{
    return succeeds([&] { removeSpring(body, spring); }, why);
}

bool btFemSoftBodySolver::setContactOffset(btSoftBody* body, btScalar metres, std::string* why)
{
    return succeeds([&] { setContactOffset(body, metres); }, why);
}

btSoftBody* btFemHelpers::createFromSurface(btSoftBodyWorldInfo& worldInfo, const bullet_fem::SurfaceMesh& surface,
                                            const bullet_fem::CageSettings& settings, std::string* why)
{
    btSoftBody* body = nullptr;
    succeeds([&] { body = createFromSurface(worldInfo, surface, settings); }, why);
    return body;
}

btSoftBody* btFemHelpers::createFromSurface(btSoftBodyWorldInfo& worldInfo, const bullet_fem::SurfaceMesh& surface,
                                            const bullet_fem::CageSettings& settings, bullet_fem::CageReport& report,
                                            std::string* why)
{
    btSoftBody* body = nullptr;
    succeeds([&] { body = createFromSurface(worldInfo, surface, settings, report); }, why);
    return body;
}

btSoftBody* btFemHelpers::createFromTetMesh(btSoftBodyWorldInfo& worldInfo, const bullet_fem::TetMesh& mesh,
                                            std::string* why)
{
    btSoftBody* body = nullptr;
    succeeds([&] { body = createFromTetMesh(worldInfo, mesh); }, why);
    return body;
}

btSoftBody* btFemHelpers::createFromTetMesh(btSoftBodyWorldInfo& worldInfo, const btVector3* positions, int nodeCount,
                                            const int* tets, int tetCount, std::string* why)
{
    btSoftBody* body = nullptr;
    succeeds([&] { body = createFromTetMesh(worldInfo, positions, nodeCount, tets, tetCount); }, why);
    return body;
}

btSoftBody* btFemHelpers::createBox(btSoftBodyWorldInfo& worldInfo, const btVector3& center,
                                    const btVector3& halfExtents, btScalar cellSize, std::string* why)
{
    btSoftBody* body = nullptr;
    succeeds([&] { body = createBox(worldInfo, center, halfExtents, cellSize); }, why);
    return body;
}

bool btFemDebugDraw::draw(const btFemSoftBodySolver& fem, const btSoftBody* body, btIDebugDraw* drawer, int modes,
                          const btFemDrawSettings& settings, std::string* why)
{
    return succeeds([&] { draw(fem, body, drawer, modes, settings); }, why);
}

btSoftBody* btFemHelpers::createFromBaked(btSoftBodyWorldInfo& worldInfo, const bullet_fem::BakedBody& baked,
                                          std::string* why)
{
    btSoftBody* body = nullptr;
    succeeds([&] { body = createFromBaked(worldInfo, baked); }, why);
    return body;
}
