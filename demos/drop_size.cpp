// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/drop_size.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace bullet_fem
{
namespace
{

constexpr double kWantedTets = 4500;
constexpr double kLeastLength = 0.01, kMostLength = 100;  // [m]

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

double area(const SurfaceMesh& surface)
{
    double sum = 0;
    for (const Triangle& t : surface.m_triangles)
    {
        const Vec3& a = surface.m_vertices[t[0]];
        sum += norm(cross(surface.m_vertices[t[1]] - a, surface.m_vertices[t[2]] - a)) / 2;
    }
    return sum;
}

// A lattice cube holds five tets. The cage holds the solid and a skin of cut elements, half of which stands out: about
// half a cell thick over the whole surface (measured on a dozen meshes). The estimate falls with the cell, so bisection
// finds it.
double cellForWantedTets(double volume, double surfaceArea, double length)
{
    const auto tets = [&](double cell) { return 5 * (volume + 0.5 * surfaceArea * cell) / (cell * cell * cell); };
    double low = 1e-3 * length, high = length / 2;
    for (int i = 0; i < 60; ++i)
    {
        const double middle = std::sqrt(low * high);
        (tets(middle) > kWantedTets ? low : high) = middle;
    }
    return high;
}

}  // namespace

DropSize chooseSize(const SurfaceMesh& surface, const DropOptions& options)
{
    const Vec3 sides = boundingBoxSides(surface);
    DropSize size;
    size.m_fileLength = std::max({sides.x, sides.y, sides.z});
    size.m_scale = options.m_scale > 0 ? options.m_scale : 1 / size.m_fileLength;
    size.m_length = size.m_scale * size.m_fileLength;
    if (!(size.m_length >= kLeastLength && size.m_length <= kMostLength))
    {
        std::ostringstream message;
        message << "the body's longest side is " << size.m_length << " m (" << size.m_fileLength
                << " in the file), must be in [" << kLeastLength << ", " << kMostLength
                << "] m; choose another --scale, or none for 1 m";
        throw std::invalid_argument(message.str());
    }
    size.m_cellSize = options.m_cellSize;
    if (size.m_cellSize == 0)
    {
        const double s = size.m_scale;
        const double box = sides.x * sides.y * sides.z;  // bounds the volume of surfaces that overlap themselves
        const double volume = std::min(std::abs(signedVolume(surface)), box) * s * s * s;
        size.m_cellSize = cellForWantedTets(volume, area(surface) * s * s, size.m_length);
    }
    return size;
}

}  // namespace bullet_fem
