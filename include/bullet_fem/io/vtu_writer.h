// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/io/body_frame.h"

namespace bullet_fem
{

/// How the numbers of a .vtu file are kept. ParaView reads all three alike.
enum class VtuEncoding
{
    text,       ///< nine digits
    binary,     ///< single precision in base 64: quickly read
    compressed  ///< that, compressed by zlib: by far the smallest
};

/// A ParaView series: one .vtu a frame and a .pvd that gives every frame its time. The .pvd is rewritten after each
/// frame, so an interrupted run can be opened.
class BULLETFEM_API VtuSeries
{
public:
    /// Writes into `folder` (made if missing) under `name`: name.pvd, name_000000.vtu and so on, over files that are
    /// there. Throws std::runtime_error naming the path if that fails, std::invalid_argument if `name` has other
    /// characters than letters, digits, '.', '_' and '-'.
    VtuSeries(std::string folder, std::string name, VtuEncoding encoding = VtuEncoding::text);

    /// A frame of bodies at `time` [s]: their tetrahedra or, where they have none, their triangles, with every field
    /// that one of them has, as point data displacement, velocity, contact_force, stress and von_mises, and as cell
    /// data body, region, stress, von_mises, plastic_strain and activation. A field that a body lacks is zero there.
    /// Each file appears as a whole or not at all. Throws std::runtime_error naming the file if it cannot be written,
    /// std::invalid_argument on arrays of different length, an index out of range, or a value that single precision
    /// does not hold; neither counts as a frame.
    void writeBodies(double time, const std::vector<BodyFrame>& bodies);

    /// The same for triangles alone, without body ids. Optional node vectors (e.g. displacement [m]) must be as many as
    /// vertices.
    void writeTriangles(double time, const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                        const std::vector<Vec3>& displacement = {});

    /// Frames so far.
    int frameCount() const { return static_cast<int>(m_times.size()); }
    /// The .pvd file that lists the frames.
    std::string pvdPath() const;

private:
    void write(double time, const std::vector<BodyFrame>& bodies, bool named);

    std::string m_folder, m_name;
    VtuEncoding m_encoding;
    std::vector<double> m_times;
};

}  // namespace bullet_fem
