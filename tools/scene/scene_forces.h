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

/// The external forces of a scene's world.
class SceneForces
{
public:
    /// Adds a force on a rigid body. `from` must outlive this object.
    void add(const SceneForce& from, btRigidBody& body);
    /// Adds a force on a body, or on all fragments of a divided one, at its initial pose. Throws std::runtime_error
    /// with the body's name if the force's box contains no free node.
    void add(const SceneForce& from, const std::vector<btSoftBody*>& bodies);

    /// After a split, divides the forces of split nodes among their copies by mass.
    void follow(const btFemSplit& split);

    /// Applies the forces in a step of the given length [s] that begins at the given time [s].
    void apply(double time, double step) const;

private:
    struct Share
    {
        btSoftBody* m_soft;
        int m_node;
        double m_share;  // fraction of the force; the sum is 1
    };
    /// A force on a rigid body or on nodes.
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
