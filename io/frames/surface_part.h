// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/io/body_frame.h"

namespace bullet_fem
{

/// The surface of a body, without interior nodes.
struct BULLETFEM_API SurfacePart
{
    /// Requires a checked body. Throws std::invalid_argument, with `caller` in the message, if it has no triangle.
    SurfacePart(const char* caller, const BodyFrame& body);

    std::vector<int> m_node;            ///< node of every vertex, ascending
    std::vector<Triangle> m_triangles;  ///< vertex triangles
};

}  // namespace bullet_fem
