// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/io/vtu_writer.h"
#include "demos/drop_scene.h"

namespace bullet_fem
{

/// The scene as two ParaView series. "body" has the file's surface with its displacement [m] from the first frame and
/// the stress [Pa] of the elements around it; "rigid" has the boxes and a square of the plane.
class DropFrames
{
public:
    /// Throws std::runtime_error if the folder cannot be made.
    DropFrames(const std::string& folder, const DropScene& scene);

    /// Writes the next frame of both series at `time` [s]. Throws std::runtime_error on failure.
    void write(double time);

    int frameCount() const { return m_bodySeries.frameCount(); }
    std::string bodyPath() const { return m_bodySeries.pvdPath(); }
    std::string rigidPath() const { return m_rigidSeries.pvdPath(); }

private:
    void writeBody(double time);
    void writeRigid(double time);
    void interpolateStress();

    const DropScene& m_scene;
    VtuSeries m_bodySeries, m_rigidSeries;
    BodyFrame m_body;
    std::vector<Vec3> m_firstPositions;
    btAlignedObjectArray<btFemStress> m_nodeStress;
};

}  // namespace bullet_fem
