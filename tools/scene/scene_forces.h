// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "tools/scene/scene_description.h"

class btRigidBody;
class btSoftBody;
struct btFemSplit;

namespace bullet_fem
{

/// The forces of a scene's world.
class SceneForces
{
public:
    /// `from` must live as long.
    void add(const SceneForce& from, btRigidBody& body);
    /// Of a body in one piece or in several, which stand where they start. Throws std::runtime_error, which names the
    /// body, where the force's box holds no free node.
    void add(const SceneForce& from, const std::vector<btSoftBody*>& bodies);

    /// A body has split: copies of its nodes have a share of what these bore, by mass.
    void follow(const btFemSplit& split);

    /// In a step of that length [s] that begins at that time [s].
    void apply(double time, double step) const;

private:
    struct Share
    {
        btSoftBody* m_soft;
        int m_node;
        double m_share;  // of the force; sum 1
    };
    /// A force, and what it acts on: a rigid body, or nodes.
    struct Force
    {
        const SceneForce* m_from;
        btRigidBody* m_rigid;
        std::vector<btSoftBody*> m_soft;
        std::vector<Share> m_nodes;
    };
    std::vector<Force> m_forces;
};

}  // namespace bullet_fem
