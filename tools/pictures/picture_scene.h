// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"
#include "tools/pictures/camera.h"

/// Content of pictures as plain values, without Bullet or finite elements.
namespace bullet_fem
{

/// A colour in sRGB, each component in [0, 1].
struct Colour
{
    double r = 0, g = 0, b = 0;
};

/// A surface of triangles, visible from both sides.
struct PictureMesh
{
    std::vector<Vec3> m_positions;      ///< [m], finite
    std::vector<Triangle> m_triangles;  ///< indices of positions
    Colour m_colour{0.86, 0.64, 0.42};  ///< if there are no scalars
    std::vector<double> m_scalars;      ///< empty, or one per position, coloured by PictureScene::m_colourScale
    /// Edges with a sharper angle stay sharp, others are shaded smoothly [rad], in [0, pi].
    double m_creaseAngle = 0.9;
    bool m_wireframe = false;  ///< draws the triangles' edges over the surface
    bool m_lit = true;         ///< false: plain colour without light and shadow
};

/// An arrow; PictureArrows::m_scale converts the unit of its vector to metres.
struct PictureArrow
{
    Vec3 m_origin;  ///< [m], finite
    Vec3 m_vector;  ///< finite; arrows shorter than a thousandth of the longest are not drawn
};

/// Arrows of one kind, such as contact forces. They show faintly through surfaces.
struct PictureArrows
{
    std::vector<PictureArrow> m_arrows;
    double m_scale = 1;      ///< metres per unit of the vectors, > 0; 1e-3 draws 1000 N as a metre
    double m_thickness = 0;  ///< diameter of the shafts [m]; 0: 1/150 of the scene
    Colour m_colour{0.80, 0.18, 0.22};
    std::string m_title = {},
                m_unit = {};  ///< for the legend, as in PictureColourScale; without a title there is no legend
    double m_longest = 0;     ///< largest vector in the legend [m_unit]; 0: none so far
};

/// An infinite plane that fades into the background, visible from above only.
struct PictureGround
{
    bool m_shown = true;
    Vec3 m_point;            ///< any point of the plane [m]
    Vec3 m_normal{0, 1, 0};  ///< upward, any length but 0
    Colour m_colour{0.86, 0.87, 0.89};
    double m_gridSpacing = 0.1;  ///< grid spacing [m]; 0: no grid
};

/// A distant key light casts shadows; a cool fill light and a rim light stand opposite to it.
struct PictureLight
{
    Vec3 m_towards{0.5, 1, 0.6};  ///< direction from the scene to the key light; any length but 0
    double m_size = 0.06;         ///< softness of shadows: the light's width over its distance, in [0, 0.5]
    bool m_shadows = true;
};

/// Mapping of scalars to colours, and text of the legend.
struct PictureColourScale
{
    double m_low = 0, m_high = 1;  ///< values at the ends of the colour map, in m_unit; low < high
    std::string m_title;           ///< for example "von Mises stress"
    std::string m_unit;            ///< for example "Pa"; an SI prefix is added if useful
    bool m_legend = true;          ///< draws the legend, if any mesh has scalars
};

/// An axis-aligned box.
struct PictureBounds
{
    Vec3 m_low, m_high;  ///< [m]

    Vec3 centre() const { return 0.5 * (m_low + m_high); }
    double radius() const { return 0.5 * norm(m_high - m_low); }
};

/// Content of a picture. Lengths are in metres; the scene may be a millimetre or a kilometre wide.
struct PictureScene
{
    std::vector<PictureMesh> m_meshes;
    std::vector<PictureArrows> m_arrows;
    PictureGround m_ground;
    PictureLight m_light;
    PictureCamera m_camera;
    PictureColourScale m_colourScale;
    /// Reference for the softness of shadows and the extent of the ground; `bounds` if not given. Use one value for all
    /// frames of a film to keep both constant. Shadows of objects farther than six of its radii may be missing.
    std::optional<PictureBounds> m_bounds;
    Colour m_sky{0.80, 0.85, 0.91}, m_horizon{0.955, 0.96, 0.965};  ///< background, at the top and at half height
    std::string m_caption;  ///< lines of text at the lower left; ASCII and Latin-1 in UTF-8
    std::string m_title;    ///< a line at the upper left
    double m_textSize = 1;  ///< text height relative to the default [-], in [0.1, 10]
};

/// Whether the scene can be drawn from `camera`; if not, `why` receives the value, its range and the remedy.
bool valid(const PictureScene& scene, const PictureCamera& camera, std::string* why = nullptr);

/// Bounding box of meshes and arrow origins [m]; a box of 1 m around the origin for an empty scene.
PictureBounds bounds(const PictureScene& scene);

/// A camera that looks from `direction` (from the scene to the eye, not 0) with `up` upwards, at the smallest distance
/// that shows all meshes in a picture of `size`.
PictureCamera framing(const PictureScene& scene, const Vec3& direction, const Vec3& up = {0, 1, 0},
                      const PictureSize& size = {});

}  // namespace bullet_fem
