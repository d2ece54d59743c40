// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// A world in staggered or in monolithic coupling, without gravity by default.
struct FastScene
{
    explicit FastScene(Coupling coupling, double gravity = 0)
        : m_world(m_fem, coupling, btVector3(0, 0, btScalar(-gravity)))
    {
    }

    /// Adds a soft body of water's density and this E [Pa].
    btSoftBody& addSoft(const TetMesh& mesh, double youngModulus = 1e6)
    {
        btSoftBody* body = btFemHelpers::createFromTetMesh(m_world.info(), mesh);
        btFemMaterial material;
        material.m_youngModulus = btScalar(youngModulus);
        m_fem.setMaterial(body, material);
        return m_world.addSoft(body);
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
};

/// A slab of 40 x 40 x 5 cm below z = 0, with cells of 5 cm, or of 2.5 cm.
inline TetMesh slab(int cellsThick)
{
    return makeBox({0.4, 0.4, 0.05}, {8 * cellsThick, 8 * cellsThick, cellsThick}, {-0.2, -0.2, -0.05});
}

/// Fixes the four sides of a slab.
inline void clampRim(btSoftBody& body)
{
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btVector3& x = body.m_nodes[i].m_x;
        if (std::max(std::fabs(x.x()), std::fabs(x.y())) > 0.199) body.setMass(i, 0);
    }
}

/// Twice the horizontal area of the triangle of the origin and two points [m2].
inline double areaSeenFromAbove(const btVector3& a, const btVector3& b)
{
    return double(a.x()) * b.y() - double(a.y()) * b.x();
}

/// Number of faces above a point: 0 above a slab, 1 inside, 2 below.
inline int facesAbove(const btSoftBody& body, const btVector3& p)
{
    int count = 0;
    for (int f = 0; f < body.m_faces.size(); ++f)
    {
        btVector3 x[3];
        double area[3], total = 0;
        for (int a = 0; a < 3; ++a) x[a] = body.m_faces[f].m_n[a]->m_x - p;
        for (int a = 0; a < 3; ++a) total += area[a] = areaSeenFromAbove(x[(a + 1) % 3], x[(a + 2) % 3]);
        const bool within =
            (area[0] >= 0 && area[1] >= 0 && area[2] >= 0) || (area[0] <= 0 && area[1] <= 0 && area[2] <= 0);
        const double height = (area[0] * x[0].z() + area[1] * x[1].z() + area[2] * x[2].z()) / total;
        count += total != 0 && within && height > 0;
    }
    return count;
}

/// A sphere, or a cylinder about the z axis.
struct Projectile
{
    std::string m_name;
    double m_radius, m_halfLength;  ///< a sphere's radius in both [m]
    double m_mass, m_speed;         ///< [kg], [m/s]
};

/// Makes the shape; the caller owns it.
inline btCollisionShape* shapeOf(const Projectile& projectile)
{
    const btScalar r(projectile.m_radius);
    if (projectile.m_halfLength == projectile.m_radius) return new btSphereShape(r);
    return new btCylinderShapeZ(btVector3(r, r, btScalar(projectile.m_halfLength)));
}

/// Adds a projectile moving downwards, with its tip `height` above z = 0.
inline btRigidBody& shoot(FastScene& scene, const Projectile& projectile, double x, double height)
{
    RigidSettings settings;
    settings.m_mass = btScalar(projectile.m_mass);
    settings.m_velocity = btVector3(0, 0, btScalar(-projectile.m_speed));
    settings.m_transform = at(btScalar(x), btScalar(0.007), btScalar(height + projectile.m_halfLength));
    settings.m_friction = btScalar(0.5);
    return scene.m_world.addRigid(shapeOf(projectile), settings);
}

}  // namespace bullet_fem
