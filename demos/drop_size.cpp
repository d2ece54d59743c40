// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/drop_size.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace bullet_fem
{
namespace
{

constexpr double kMinLength = 0.01, kMaxLength = 100;  // [m]

Vec3 boundingBoxSides(const SurfaceMesh& surface)
{
    Vec3 low = surface.m_vertices.front(), high = low;
    for (const Vec3& v : surface.m_vertices)
        for (int c = 0; c < 3; ++c)
        {
            low[c] = std::min(low[c], v[c]);
            high[c] = std::max(high[c], v[c]);
        }
    return high - low;
}

}  // namespace

DropSize chooseSize(const SurfaceMesh& surface, const DropOptions& options)
{
    const Vec3 sides = boundingBoxSides(surface);
    DropSize size;
    size.m_fileLength = std::max({sides.x, sides.y, sides.z});
    size.m_scale = options.m_scale > 0 ? options.m_scale : 1 / size.m_fileLength;
    size.m_length = size.m_scale * size.m_fileLength;
    if (!(size.m_length >= kMinLength && size.m_length <= kMaxLength))
    {
        std::ostringstream message;
        message << "the body's longest side is " << size.m_length << " m (" << size.m_fileLength
                << " in the file), must be in [" << kMinLength << ", " << kMaxLength
                << "] m; choose another --scale, or none for 1 m";
        throw std::invalid_argument(message.str());
    }
    return size;
}

}  // namespace bullet_fem
