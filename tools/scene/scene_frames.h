// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_fem/btFemReports.h"
#include "bullet_fem/io/body_frame.h"
#include "io/frames/surface_part.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem
{

/// What writers and pictures show of a scene: taken anew by `update`, after a step.
class SceneFrames
{
public:
    /// The world must live longer.
    explicit SceneFrames(const SceneWorld& world);

    /// `fraction`: of pictures between two steps, the time in steps from the end of the last one [-], in [-1, 1]; see
    /// btFemHelpers::interpolateNodes(). Forces, stress and velocities are those of the last step.
    void update(double fraction = 0);

    /// The soft bodies' elements, in the scene's order: all fields.
    const std::vector<BodyFrame>& volumes() const { return m_volumes; }
    /// Surfaces: of the soft bodies, embedded ones where there are, with their stress and without nodes that no
    /// triangle has; then of the rigid ones that have a shape with an end.
    const std::vector<BodyFrame>& surfaces() const { return m_surfaces; }
    /// Which body of the scene a surface is: index of a soft body, or the number of soft bodies plus that of a rigid
    /// one.
    int bodyOf(int surface) const { return m_surfaces[surface].m_id; }

private:
    void takeElements(int i);
    void followSplits(int i);
    void updateVolume(int i, double fraction);
    void updateReactions(const btSoftBody& body, BodyFrame& frame);
    void updateSoftSurface(int i);
    void updateRigidSurface(int surface, double fraction);

    const SceneWorld& m_world;
    std::vector<BodyFrame> m_volumes, m_surfaces;
    std::vector<SurfacePart> m_drawn;            // a soft body: its surface's nodes or embedded vertices
    std::vector<std::vector<Vec3>> m_rest;       // a soft body: nodes at the start
    std::vector<int> m_splits;                   // a soft body: how often it had split when its elements were taken
    std::vector<std::vector<Vec3>> m_rigidRest;  // a surface of a rigid body: in its own frame
    btAlignedObjectArray<btFemStress> m_stress;
    btAlignedObjectArray<btScalar> m_perElement;
    btAlignedObjectArray<btVector3> m_forces, m_places;
};

}  // namespace bullet_fem
