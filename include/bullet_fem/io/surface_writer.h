// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/io/body_frame.h"

namespace bullet_fem
{

/// Writes the bodies' surfaces as an OBJ file: one object per body ("body_<id>"), with nine digits. The file appears as
/// a whole or not at all. Throws std::runtime_error naming the path if it cannot be written, std::invalid_argument as
/// VtuSeries::writeBodies does, and on a body without triangles.
BULLETFEM_API void writeObj(const std::string& path, const std::vector<BodyFrame>& bodies);

/// Writes the bodies' surfaces as one binary PLY mesh (single precision, little endian): vertices with x, y, z and, if
/// a body has node stress, von_mises [Pa] and its colour as red, green and blue, from 0 to `hottest` [Pa] (0: the
/// maximum present); faces with vertex_indices and the body's id as body. The file appears as a whole or not at all.
/// Throws std::runtime_error naming the path if it cannot be written, std::invalid_argument as VtuSeries::writeBodies
/// does, on a body without triangles, and on a `hottest` outside [0, inf).
BULLETFEM_API void writePly(const std::string& path, const std::vector<BodyFrame>& bodies, double hottest = 0);

}  // namespace bullet_fem
