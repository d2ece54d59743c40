// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// Soft cubes and rigid boxes of 0.5 m with anchors between them.
class AnchorScene
{
public:
    static constexpr double kHalf = 0.25;                  ///< of cubes and boxes [m]
    static constexpr double kCubeWeight = 125 * kGravity;  ///< of a soft cube of 1000 kg/m3 [N]

    explicit AnchorScene(Coupling coupling = Coupling::swap, const btVector3& gravity = {0, 0, btScalar(-kGravity)},
                         WorldClass worldClass = WorldClass::softRigid)
        : m_world(worldClass, coupling, gravity)
    {
    }

    btSoftBody& addCube(const btVector3& center, double youngModulus = 1e6, double density = 1000)
    {
        const btScalar half(kHalf);
        btSoftBody& cube =
            m_world.addSoft(btFemHelpers::createBox(m_world.info(), center, btVector3(half, half, half), half));
        btFemMaterial material;
        material.m_youngModulus = btScalar(youngModulus);
        material.m_density = btScalar(density);
        m_fem.setMaterial(&cube, material);
        return cube;
    }

    btRigidBody& addBox(btScalar mass, const btVector3& position)
    {
        const btScalar half(kHalf);
        return m_world.addRigid(new btBoxShape(btVector3(half, half, half)),
                                {mass, at(position.x(), position.y(), position.z())});
    }

    /// Indices of the nodes at this height.
    static std::vector<int> nodesAt(const btSoftBody& body, double height)
    {
        std::vector<int> nodes;
        for (int i = 0; i < body.m_nodes.size(); ++i)
            if (std::fabs(body.m_nodes[i].m_x.z() - height) < 1e-4) nodes.push_back(i);
        return nodes;
    }

    static void anchorAll(btSoftBody& body, const std::vector<int>& nodes, btRigidBody& to)
    {
        for (int i : nodes) body.appendAnchor(i, &to, true);
    }

    /// Sum of the impulses of anchors to an object.
    Vec3 impulseOf(const btSoftBody& body, const btCollisionObject& object) const
    {
        Vec3 sum;
        const btAlignedObjectArray<btFemAnchorReport>& anchors = m_fem.anchors(&body);
        for (int k = 0; k < anchors.size(); ++k)
            if (anchors[k].m_object == &object) sum += vec3(anchors[k].m_impulse);
        return sum;
    }

    double largestError(const btSoftBody& body) const
    {
        double largest = 0;
        const btAlignedObjectArray<btFemAnchorReport>& anchors = m_fem.anchors(&body);
        for (int k = 0; k < anchors.size(); ++k) largest = std::max(largest, double(anchors[k].m_error));
        return largest;
    }

    /// Maximum difference between an object's anchor force and `load` [N] over a number of steps, relative to the load.
    double worstForce(int steps, const btSoftBody& body, const btCollisionObject& object, const Vec3& load)
    {
        double worst = 0;
        for (int k = 0; k < steps; ++k)
        {
            m_world.step();
            const double error = norm((1 / double(kStep)) * impulseOf(body, object) - load) / norm(load);
            EXPECT_TRUE(std::isfinite(error));
            worst = std::max(worst, error);
        }
        return worst;
    }

    FemWorld m_world;
    btFemSoftBodySolver& m_fem = m_world.fem();
};

}  // namespace bullet_fem
