// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/fem/baked/baked_body.h"
#include "io/temporary_folder.h"

namespace bullet_fem
{

/// Whether this program's Bullet is in single precision.
constexpr bool kSingle = sizeof(btScalar) == sizeof(float);

/// Writes the body to a file and reads it back.
inline BakedBody throughAFile(const BakedBody& baked)
{
    const TemporaryFolder folder;
    writeBakedBody(folder.path("body.bfem"), baked);
    return readBakedBody(folder.path("body.bfem"));
}

/// The settings of an unbaked body.
inline btFemMaterial bulletMaterial(const Material& m)
{
    btFemMaterial material;
    material.m_youngModulus = static_cast<btScalar>(m.m_youngModulus);
    material.m_poissonRatio = static_cast<btScalar>(m.m_poissonRatio);
    material.m_density = static_cast<btScalar>(m.m_density);
    material.m_massDamping = static_cast<btScalar>(m.m_massDamping);
    material.m_stiffnessDamping = static_cast<btScalar>(m.m_stiffnessDamping);
    material.m_law = static_cast<btFemElasticLaw>(m.m_law);
    material.m_bending = static_cast<btFemBending>(m.m_bending);
    return material;
}

/// An octahedron whose corners are at this distance from the centre [m].
inline SurfaceMesh octahedron(double radius, const Vec3& centre)
{
    SurfaceMesh surface;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {radius, -radius})
        {
            surface.m_vertices.push_back(centre);
            surface.m_vertices.back()[axis] += side;
        }
    for (int k = 0; k < 8; ++k)
    {
        const int x = k & 1, y = 2 + (k >> 1 & 1), z = 4 + (k >> 2);
        const bool even = ((k & 1) + (k >> 1 & 1) + (k >> 2)) % 2 == 0;
        surface.m_triangles.push_back(even ? Triangle{x, y, z} : Triangle{x, z, y});
    }
    return surface;
}

}  // namespace bullet_fem
