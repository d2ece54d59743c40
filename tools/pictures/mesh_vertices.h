// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "tools/pictures/picture_scene.h"

namespace bullet_fem
{

/// Positions for the graphics card: relative to the scene's centre, in units of its radius. In metres, single precision
/// would be insufficient far from the origin and for very small or large scenes.
struct PictureUnits
{
    Vec3 m_origin;        ///< [m]
    double m_length = 1;  ///< [m], > 0

    Vec3 place(const Vec3& x) const { return (1 / m_length) * (x - m_origin); }
};

/// A vertex for the graphics card. Three in a row form a triangle.
struct PictureVertex
{
    float m_position[3];  ///< in PictureUnits
    float m_normal[3];
    float m_share;  ///< position in the colour map
};

/// Appends the mesh's triangles. The normal at a corner is the area-weighted mean over adjacent faces that deviate from
/// its own face by at most the crease angle. The mesh must be valid.
void appendVertices(const PictureMesh& mesh, const PictureUnits& units, const PictureColourScale& scale,
                    std::vector<PictureVertex>& vertices);

/// Appends shafts and heads of the arrows.
void appendVertices(const PictureArrows& arrows, const PictureUnits& units, std::vector<PictureVertex>& vertices);

}  // namespace bullet_fem
