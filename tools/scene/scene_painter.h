// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "tools/pictures/picture_scene.h"
#include "tools/scene/scene_frames.h"

namespace bullet_fem
{

/// Variable data of a picture, stored so that a film can be drawn after its colour scale is known.
struct SceneSnapshot
{
    double m_time = 0;                           ///< [s]
    std::vector<std::vector<Vec3>> m_positions;  ///< of each surface of SceneFrames [m]
    /// Triangles of bodies that can split; empty for others, whose triangles stay constant.
    std::vector<std::vector<Triangle>> m_triangles;
    std::vector<std::vector<double>> m_vonMises;  ///< of each surface [Pa]; empty for rigid bodies or if not shown
    std::vector<PictureArrow> m_forces;           ///< contact forces [N]; empty if not shown
};
SceneSnapshot snapshotOf(const SceneWorld& world, const SceneFrames& frames);

/// The 98 % quantile of von Mises stress over the vertices, of the snapshot with the largest one [Pa]; at least 1 Pa.
/// Stress peaks of single elements at clamps and edges would otherwise dominate the colour scale.
double hottestOf(const std::vector<SceneSnapshot>& snapshots);

/// Maximum nodal force over all snapshots [N]; 0 if none is shown.
double largestForceOf(const std::vector<SceneSnapshot>& snapshots);

/// Draws snapshots of one scene with constant camera, colours and scale.
class ScenePainter
{
public:
    /// Frames the camera by the initial `frames`. Both arguments must outlive this object. Arrows and ground scale with
    /// `size`, a radius [m]; 0: that of the frames.
    ScenePainter(const SceneWorld& world, const SceneFrames& frames, double size = 0);

    /// Sets the stress of the last colour [Pa], > 0.
    void setHottest(double pascal) { m_picture.m_colourScale.m_high = pascal; }

    /// Sets the force whose arrow has a quarter of the scene's length [N], > 0.
    void setLargestForce(double newton);

    /// Multiplies the distance of a framed camera by a factor > 0; has no effect on a camera placed by the scene.
    void widenView(double factor);
    const PictureCamera& camera() const { return m_picture.m_camera; }

    /// The result is valid until the next call.
    const PictureScene& paint(const SceneSnapshot& snapshot);

private:
    void placeCamera();

    const SceneWorld& m_world;
    PictureScene m_picture;
    double m_size;  // radius of the initial scene [m]
};

}  // namespace bullet_fem
