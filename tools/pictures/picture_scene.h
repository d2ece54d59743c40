// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"
#include "tools/pictures/camera.h"

/// What is to be drawn, as plain values: neither Bullet nor finite elements are known here.
namespace bullet_fem
{

/// A colour as a screen shows it (sRGB), each part in [0, 1].
struct Colour
{
    double r = 0, g = 0, b = 0;
};

/// A surface of triangles. Both sides are drawn.
struct PictureMesh
{
    std::vector<Vec3> m_positions;      ///< [m], finite
    std::vector<Triangle> m_triangles;  ///< indices of positions
    Colour m_colour{0.86, 0.64, 0.42};  ///< where there are no scalars
    std::vector<double> m_scalars;      ///< none, or one a position: coloured by PictureScene::m_colourScale
    double m_creaseAngle = 0.9;  ///< edges sharper than this stay sharp, others are shaded round [rad], in [0, pi]
    bool m_wireframe = false;    ///< draws the triangles' edges over the surface
    bool m_lit = true;           ///< false: the plain colour, without light and shadow
};

/// An arrow from its origin; the vector's unit is whatever PictureArrows::m_scale turns into metres.
struct PictureArrow
{
    Vec3 m_origin;  ///< [m], finite
    Vec3 m_vector;  ///< finite; arrows shorter than a thousandth of the longest are left out
};

/// Arrows of one kind, such as contact forces. Behind surfaces they shine through faintly.
struct PictureArrows
{
    std::vector<PictureArrow> m_arrows;
    double m_scale = 1;      ///< metres a unit of the vectors, > 0; 1e-3 draws 1000 N as a metre
    double m_thickness = 0;  ///< diameter of the shafts [m]; 0: 1/150 of the scene
    Colour m_colour{0.80, 0.18, 0.22};
    std::string m_title = {},
                m_unit = {};  ///< for the legend, as in PictureColourScale; without a title it has no arrows
    double m_longest = 0;     ///< the vector that the legend tells [m_unit]; 0: there was none yet
};

/// An endless plane that fades into the background. It is seen from above only.
struct PictureGround
{
    bool m_shown = true;
    Vec3 m_point;            ///< any point of it [m]
    Vec3 m_normal{0, 1, 0};  ///< up; of any length but 0
    Colour m_colour{0.86, 0.87, 0.89};
    double m_gridSpacing = 0.1;  ///< between grid lines [m]; 0: no grid
};

/// The key light is far away and casts the shadows; a cool fill light and a rim light stand opposite to it.
struct PictureLight
{
    Vec3 m_towards{0.5, 1, 0.6};  ///< direction from the scene to the key light; of any length but 0
    double m_size = 0.06;         ///< how soft shadows are: the light's width over its distance, in [0, 0.5]
    bool m_shadows = true;
};

/// How scalars become colours, and what the legend says.
struct PictureColourScale
{
    double m_low = 0, m_high = 1;  ///< what the ends of the colour map stand for, in m_unit; low < high
    std::string m_title;           ///< for example "von Mises stress"
    std::string m_unit;            ///< for example "Pa"; a SI prefix is added where that reads better
    bool m_legend = true;          ///< draws the legend, if any mesh has scalars
};

/// A box along the axes.
struct PictureBounds
{
    Vec3 m_low, m_high;  ///< [m]

    Vec3 centre() const { return 0.5 * (m_low + m_high); }
    double radius() const { return 0.5 * norm(m_high - m_low); }
};

/// A picture's content. Lengths are in metres, of any magnitude: the scene may be a millimetre or a kilometre wide.
struct PictureScene
{
    std::vector<PictureMesh> m_meshes;
    std::vector<PictureArrows> m_arrows;
    PictureGround m_ground;
    PictureLight m_light;
    PictureCamera m_camera;
    PictureColourScale m_colourScale;
    /// What the softness of shadows and the reach of the ground are measured by; `bounds` unless given. Frames of a
    /// film get the same one, or these would change with what moves. Shadows of what is farther than six of its radii
    /// may be missing.
    std::optional<PictureBounds> m_bounds;
    Colour m_sky{0.80, 0.85, 0.91}, m_horizon{0.955, 0.96, 0.965};  ///< background, above and at half height
    std::string m_caption;  ///< lines of text at the lower left, ASCII and Latin-1 as UTF-8
    std::string m_title;    ///< a line at the upper left
    double m_textSize = 1;  ///< letters' height over what suits the picture [-], in [0.1, 10]
};

/// Whether the scene can be drawn as seen by `camera`; if not, `why` names the value, the range and the remedy.
bool valid(const PictureScene& scene, const PictureCamera& camera, std::string* why = nullptr);

/// The smallest box around meshes and arrows' origins [m]; a box of 1 m around the origin if there are none.
PictureBounds bounds(const PictureScene& scene);

/// A camera that looks from `direction` (from the scene to the eye, not 0), with `up` upwards, and as near as it can be
/// with all meshes in view in a picture of `size`.
PictureCamera framing(const PictureScene& scene, const Vec3& direction, const Vec3& up = {0, 1, 0},
                      const PictureSize& size = {});

}  // namespace bullet_fem
