// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "tools/pictures/picture_scene.h"
#include "tools/scene/scene_frames.h"

namespace bullet_fem
{

/// What changes from picture to picture, kept so that a film can be drawn when its colour scale is known.
struct SceneSnapshot
{
    double m_time = 0;                           ///< [s]
    std::vector<std::vector<Vec3>> m_positions;  ///< a surface of SceneFrames, a vertex [m]
    /// Likewise of bodies that may split; empty for others, whose triangles are those of the start.
    std::vector<std::vector<Triangle>> m_triangles;
    std::vector<std::vector<double>> m_vonMises;  ///< likewise [Pa]; empty for rigid bodies, or if not shown
    std::vector<PictureArrow> m_forces;           ///< of contact [N]; empty if not shown
};
SceneSnapshot snapshotOf(const SceneWorld& world, const SceneFrames& frames);

/// The von Mises stress that 98 % of the vertices do not exceed, in the snapshot where that is most [Pa]; at least 1
/// Pa. Single elements at clamps and edges are hotter than all else, and would leave the rest of a picture dark.
double hottestOf(const std::vector<SceneSnapshot>& snapshots);

/// The largest force at a node in all snapshots [N]; 0 if none is shown.
double largestForceOf(const std::vector<SceneSnapshot>& snapshots);

/// Draws snapshots of one scene, all with the same camera, colours and scale.
class ScenePainter
{
public:
    /// `frames` as they are at the start, which the camera is framed by. Both must live longer. Arrows and ground go by
    /// `size`, a radius [m]; 0: the frames'.
    ScenePainter(const SceneWorld& world, const SceneFrames& frames, double size = 0);

    /// The stress of the last colour [Pa], > 0.
    void setHottest(double pascal) { m_picture.m_colourScale.m_high = pascal; }

    /// The force whose arrow is a quarter of the scene long [N], > 0.
    void setLargestForce(double newton);

    /// Moves a camera that is framed, not placed, to so many times its distance, > 0.
    void widenView(double factor);
    const PictureCamera& camera() const { return m_picture.m_camera; }

    /// Valid until the next call.
    const PictureScene& paint(const SceneSnapshot& snapshot);

private:
    void placeCamera();

    const SceneWorld& m_world;
    PictureScene m_picture;
    double m_size;  // radius of the scene at the start [m]
};

}  // namespace bullet_fem
