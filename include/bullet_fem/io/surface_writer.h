// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/io/body_frame.h"

namespace bullet_fem
{

/// One frame of the bodies' surfaces as an OBJ file: an object a body ("body_<id>"), with nine digits. The file appears
/// as a whole or not at all. Throws std::runtime_error naming the path if it cannot be written, std::invalid_argument
/// on what VtuSeries::writeBodies throws it on, or a body without triangles.
BULLETFEM_API void writeObj(const std::string& path, const std::vector<BodyFrame>& bodies);

/// The same as one binary PLY mesh (single precision, little endian): vertices with x, y, z and, if a body has node
/// stress, von_mises [Pa] and its colour as red, green and blue, from 0 to `hottest` [Pa] (0: the highest there is);
/// faces with vertex_indices and the body's id as body. Throws likewise, and on a `hottest` that is not in [0, inf).
BULLETFEM_API void writePly(const std::string& path, const std::vector<BodyFrame>& bodies, double hottest = 0);

}  // namespace bullet_fem
