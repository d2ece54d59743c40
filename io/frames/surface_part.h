// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/io/body_frame.h"

namespace bullet_fem
{

/// A body's surface without the nodes inside.
struct BULLETFEM_API SurfacePart
{
    /// Of a body that has been checked. Throws std::invalid_argument, in the name of `caller`, if it has no triangle.
    SurfacePart(const char* caller, const BodyFrame& body);

    std::vector<int> m_node;            ///< of every vertex, ascending
    std::vector<Triangle> m_triangles;  ///< of vertices
};

}  // namespace bullet_fem
