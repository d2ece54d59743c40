// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "BulletSoftBody/btDeformableBodySolver.h"
#include "bullet_bridge/body/held_joint.h"
#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/fem/common/vec3.h"

/// Material of the elastic forces on a body.
struct btFemForceMaterial
{
    bool m_given = false;  ///< such a force exists
    btFemMaterial m_material;

    bool operator==(const btFemForceMaterial& b) const;
    bool operator!=(const btFemForceMaterial& b) const { return !(*this == b); }
};

/// A node under mouse picking. The spring's handle is negative and constant over steps.
struct btFemDrawnNode
{
    const btSoftBody* m_body;
    bullet_fem::NodeSpring m_spring;
};

/// The forces of a deformable world. Bullet's solver must not use those on FEM bodies: it finds nodes by an index that
/// nodes of FEM bodies do not have.
class btFemDeformableForces
{
public:
    using Force = btDeformableLagrangianForce;
    using Bodies = btAlignedObjectArray<btSoftBody*>;

    /// The list of forces to which the user and the world add.
    btAlignedObjectArray<Force*>& all() { return m_all; }

    /// The material of the elastic forces on a body; their mu and lambda are summed.
    btFemForceMaterial materialOf(const btSoftBody& body) const;

    /// Gravitational acceleration [m/s2].
    bullet_fem::Vec3 gravityOf(const btSoftBody& body) const;

    /// Removes bodies from all forces, and lists for Bullet's solver the remaining forces: those on other bodies only,
    /// or with separate bodies.
    void hide(const Bodies& bodies, btAlignedObjectArray<Force*>& left);

    /// Undoes hide(), except for bodies and forces that no longer exist in `world` and all().
    void show(const Bodies& world);

    /// Adds to m_f of FEM bodies the forces other than elasticity, links and gravity in a step of `step` [s], and to
    /// the velocities of `plain` bodies the effect of forces that act on FEM bodies, too. Mouse picking of FEM bodies
    /// is excluded: see drawn(). Call between hide and show; the nodes of plain bodies must have their indices. Sets
    /// the index of FEM bodies' nodes to 0.
    void addTo(const Bodies& fem, const Bodies& plain, double step);

    /// Nodes under mouse picking in the step of the last addTo, without its damping, which addTo adds to m_f.
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
    Vectors m_impulse, m_direction, m_change, m_stiffness, m_damping, m_place;  // scratch, per node index
    Bodies m_others;                                                            // scratch
};
