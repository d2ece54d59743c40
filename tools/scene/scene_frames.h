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

/// Data of a scene for writers and pictures, updated by `update` after a step.
class SceneFrames
{
public:
    /// The world must outlive this object.
    explicit SceneFrames(const SceneWorld& world);

    /// `fraction`: for pictures between two steps, time in steps from the end of the last step [-], in [-1, 1]; see
    /// btFemHelpers::interpolateNodes(). Forces, stress and velocities are those of the last step.
    void update(double fraction = 0);

    /// Elements of the soft bodies with all fields, in the scene's order.
    const std::vector<BodyFrame>& volumes() const { return m_volumes; }
    /// Surfaces: first those of soft bodies (the embedded one if there is any) with stress and without unused nodes,
    /// then those of rigid bodies of finite extent.
    const std::vector<BodyFrame>& surfaces() const { return m_surfaces; }
    /// Body of a surface: index of a soft body, or the number of soft bodies plus the index of a rigid body.
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
    std::vector<SurfacePart> m_drawn;            // per soft body: nodes of its surface or embedded vertices
    std::vector<std::vector<Vec3>> m_rest;       // per soft body: initial nodes
    std::vector<int> m_splits;                   // per soft body: number of splits when its elements were copied
    std::vector<std::vector<Vec3>> m_rigidRest;  // per surface of a rigid body: in its own frame
    btAlignedObjectArray<btFemStress> m_stress;
    btAlignedObjectArray<btScalar> m_perElement;
    btAlignedObjectArray<btVector3> m_forces, m_places;
};

}  // namespace bullet_fem
