// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/body/soft_body_mesh.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{

/// A btSoftBody of a mesh's tetrahedra, 1 kg a node.
inline std::unique_ptr<btSoftBody> makeSoftBody(btSoftBodyWorldInfo& info, const TetMesh& mesh)
{
    btAlignedObjectArray<btVector3> positions;
    for (const Vec3& X : mesh.restPositions()) positions.push_back(bulletVector(X));
    auto body = std::make_unique<btSoftBody>(&info, positions.size(), &positions[0], nullptr);
    for (const Tet& t : mesh.tets()) body->appendTetra(t[0], t[1], t[2], t[3]);
    return body;
}

/// The btSoftBody of a cube, outside any world.
struct TestBox
{
    explicit TestBox(const Vec3& origin = {}) : m_body(makeSoftBody(m_info, makeBox({1, 1, 1}, {2, 2, 2}, origin))) {}

    btSoftBodyWorldInfo m_info;
    std::unique_ptr<btSoftBody> m_body;
};

inline FactorInput factorInputOf(const btSoftBody& body)
{
    FactorInput input;
    input.m_mass.assign(body.m_nodes.size(), 1.0);
    input.m_fixed.assign(body.m_nodes.size(), 0);
    return input;
}

/// Makes a FEM soft body of the default material, factored for a step of 1/60 s.
inline FemSoftBody makeFemSoftBody(btSoftBody& body)
{
    const auto shape = std::make_shared<const RestShape>(tetMeshOf(body), unsetMaterialOf(body));
    const auto model = BodyModel::create(shape, factorInputOf(body));
    return FemSoftBody(body, model, makeComplianceCache(model));
}

}  // namespace bullet_fem
