// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "BulletSoftBody/btDeformableBodySolver.h"
#include "bullet_bridge/body/held_joint.h"
#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/fem/common/vec3.h"

/// What the elastic forces on a body amount to.
struct btFemForceMaterial
{
    bool m_given = false;  ///< there is one
    btFemMaterial m_material;

    bool operator==(const btFemForceMaterial& b) const;
    bool operator!=(const btFemForceMaterial& b) const { return !(*this == b); }
};

/// A node that a mouse draws. The spring's handle is negative, and the same in every step.
struct btFemDrawnNode
{
    const btSoftBody* m_body;
    bullet_fem::NodeSpring m_spring;
};

/// The forces of a deformable world. Bullet's solver must not see those on FEM bodies: it finds nodes by an index that
/// FEM bodies' nodes do not have.
class btFemDeformableForces
{
public:
    using Force = btDeformableLagrangianForce;
    using Bodies = btAlignedObjectArray<btSoftBody*>;

    /// What the user, and the world, add to and remove from.
    btAlignedObjectArray<Force*>& all() { return m_all; }

    /// The material of the elastic forces on a body: their mu and lambda summed.
    btFemForceMaterial materialOf(const btSoftBody& body) const;

    /// Acceleration by gravity [m/s2].
    bullet_fem::Vec3 gravityOf(const btSoftBody& body) const;

    /// Takes bodies off all forces, and lists the forces that are left for Bullet's solver: all that act on others
    /// alone, or body by body.
    void hide(const Bodies& bodies, btAlignedObjectArray<Force*>& left);

    /// Undoes hide, but for bodies and forces that are gone since: what `world` and all() do not hold.
    void show(const Bodies& world);

    /// Adds to m_f of FEM bodies what forces other than elasticity, springs and gravity do to them in a step of `step`
    /// [s], and to the velocities of `plain` bodies what such forces do to them if they are on FEM bodies, too; but for
    /// how a mouse draws FEM bodies, which drawn() tells. While they are hidden; the plain bodies' nodes must have
    /// their indices. FEM bodies' nodes have index 0 after that.
    void addTo(const Bodies& fem, const Bodies& plain, double step);

    /// By mouse picking forces, in the step of the last addTo. Their damping is not in it: addTo adds that.
    const std::vector<btFemDrawnNode>& drawn() const { return m_drawn; }

private:
    struct Hidden
    {
        Force* m_force;
        btSoftBody* m_body;
    };
    using Vectors = btAlignedObjectArray<btVector3>;

    bool evaluate(Force& force, int size, double step);
    void takeDrawn(int number, const Bodies& fem, double step);
    bullet_fem::Vec3 wayLeft(Force& force, btSoftBody::Node& node, const bullet_fem::NodeSpring& spring, double step);
    void findMouse(Force& force, btSoftBody::Node& node, bullet_fem::NodeSpring& spring, double step);
    double stiffnessOf(const btSoftBody::Node& node) const;
    btVector3 yieldingImpulse(const btSoftBody::Node& node, double step) const;

    btAlignedObjectArray<Force*> m_all;
    std::vector<Hidden> m_hidden;
    std::vector<btFemDrawnNode> m_drawn;
    Vectors m_impulse, m_direction, m_change, m_stiffness, m_damping, m_place;  // scratch, per index of a node
    Bodies m_others;                                                            // likewise
};
