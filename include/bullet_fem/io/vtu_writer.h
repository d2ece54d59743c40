// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/fem/surface_mesh.h"
#include "bullet_fem/fem/tet_mesh.h"

namespace bullet_fem
{

/// A ParaView series: one .vtu a frame and a .pvd that gives every frame its time. The .pvd is rewritten after each
/// frame, so an interrupted run can be opened.
class VtuSeries
{
public:
    /// Writes into `folder` (made if missing) under `name`: name.pvd, name_000000.vtu and so on, over files that are
    /// there. Throws std::runtime_error naming the path if that fails, std::invalid_argument if `name` has other
    /// characters than letters, digits, '.', '_' and '-'.
    VtuSeries(std::string folder, std::string name);

    /// A frame of triangles at `time` [s]. Optional node vectors (e.g. displacement [m]) must be as many as vertices.
    /// Throws std::runtime_error naming the file if it cannot be written, std::invalid_argument on arrays of different
    /// length, a triangle index out of range, or a value that is not finite; neither counts as a frame.
    void writeTriangles(double time, const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                        const std::vector<Vec3>& displacement = {});

    int frameCount() const { return static_cast<int>(m_times.size()); }
    std::string pvdPath() const;

private:
    std::string m_folder, m_name;
    std::vector<double> m_times;
};

}  // namespace bullet_fem
