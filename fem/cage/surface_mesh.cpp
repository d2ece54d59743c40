// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/cage/surface_mesh.h"

namespace bullet_fem
{

double signedVolume(const SurfaceMesh& surface)
{
    if (surface.m_vertices.empty()) return 0;
    Vec3 centroid;  // nearby origin, for the accuracy of a small body far away
    for (const Vec3& x : surface.m_vertices) centroid += x * (1.0 / static_cast<double>(surface.m_vertices.size()));
    double sum = 0;
    for (const Triangle& t : surface.m_triangles)
        sum += dot(surface.m_vertices[t[0]] - centroid,
                   cross(surface.m_vertices[t[1]] - centroid, surface.m_vertices[t[2]] - centroid));
    return sum / 6;
}

}  // namespace bullet_fem
