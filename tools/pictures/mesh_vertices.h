// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "tools/pictures/picture_scene.h"

namespace bullet_fem
{

/// Places as the graphics card sees them: from the scene's centre, in units of its radius. In metres, single precision
/// would lose places far from zero, and scenes that are very small or large.
struct PictureUnits
{
    Vec3 m_origin;        ///< [m]
    double m_length = 1;  ///< [m], > 0

    Vec3 place(const Vec3& x) const { return (1 / m_length) * (x - m_origin); }
};

/// A corner of a triangle as it goes to the graphics card. Three in a row are a triangle.
struct PictureVertex
{
    float m_position[3];  ///< in PictureUnits
    float m_normal[3];
    float m_share;  ///< of the colour map
};

/// Appends the mesh's triangles. Normals are the mean of the faces around a corner that do not turn away from its own
/// face by more than the crease angle, weighted with their areas. The mesh has been checked.
void appendVertices(const PictureMesh& mesh, const PictureUnits& units, const PictureColourScale& scale,
                    std::vector<PictureVertex>& vertices);

/// Appends shafts and heads.
void appendVertices(const PictureArrows& arrows, const PictureUnits& units, std::vector<PictureVertex>& vertices);

}  // namespace bullet_fem
