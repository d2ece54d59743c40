// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/io/body_frame.h"

namespace bullet_fem
{

/// Encoding of the numbers of a .vtu file. ParaView reads all three.
enum class VtuEncoding
{
    text,       ///< nine digits
    binary,     ///< single precision in base 64: fast to read
    compressed  ///< single precision, compressed by zlib, in base 64: by far the smallest
};

/// A ParaView series: one .vtu file per frame, and a .pvd file with the times of the frames. The .pvd is rewritten
/// after each frame, so the series of an interrupted run can be opened.
class BULLETFEM_API VtuSeries
{
public:
    /// Writes into `folder` (created if missing) under `name`: name.pvd, name_000000.vtu and so on, replacing existing
    /// files. Throws std::runtime_error naming the path if that fails, std::invalid_argument if `name` has characters
    /// other than letters, digits, '.', '_' and '-'.
    VtuSeries(std::string folder, std::string name, VtuEncoding encoding = VtuEncoding::text);

    /// Writes a frame of bodies at `time` [s]: their tetrahedra or, without these, their triangles, with every field
    /// that any of them has: point data displacement, velocity, contact_force, stress and von_mises, cell data body,
    /// region, stress, von_mises, plastic_strain and activation. A missing field of a body is written as zero. Each
    /// file appears as a whole or not at all. Throws std::runtime_error naming the file if it cannot be written,
    /// std::invalid_argument on arrays of different length, an index out of range, or a value that single precision
    /// cannot represent; the frame does not count then.
    void writeBodies(double time, const std::vector<BodyFrame>& bodies);

    /// Writes a frame of triangles at `time` [s], without body ids. `displacement` [m], one per vertex, may be empty.
    /// Throws as writeBodies does.
    void writeTriangles(double time, const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                        const std::vector<Vec3>& displacement = {});

    /// Number of frames so far.
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
