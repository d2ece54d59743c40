// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <vector>

#include "BulletCollision/CollisionShapes/btSdfCollisionShape.h"
#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// A signed distance function and the box about the origin in which it is sampled.
struct SampledField
{
    std::function<double(const Vec3&)> m_distance;
    Vec3 m_halfSize = {1, 1, 1};  ///< of the domain [m]
    unsigned m_cells = 8;         ///< along each axis
};

/// The bytes that btSdfCollisionShape reads: cubic cells of 32 nodes (8 corners and two points on each edge), in the
/// order of its shape functions.
inline std::vector<char> sdfFile(const SampledField& field)
{
    std::vector<char> file;
    const auto write = [&file](const auto& value)
    {
        const auto* bytes = reinterpret_cast<const char*>(&value);
        file.insert(file.end(), bytes, bytes + sizeof(value));
    };
    const Vec3 &half = field.m_halfSize, cell = (2.0 / field.m_cells) * half;
    const std::uint64_t one = 1, cells = std::uint64_t(field.m_cells) * field.m_cells * field.m_cells;
    for (double sign : {-1.0, 1.0})
        for (int c = 0; c < 3; ++c) write(sign * half[c]);
    for (int c = 0; c < 3; ++c) write(field.m_cells);
    for (int c = 0; c < 3; ++c) write(cell[c]);
    for (int c = 0; c < 3; ++c) write(1 / cell[c]);
    write(cells);
    write(one);
    std::vector<Vec3> nodes;  // in [-1, 1]^3
    for (int k = 0; k < 8; ++k) nodes.push_back({k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0});
    // For each edge axis the two other axes: the fast index, then the slow one.
    const std::array<std::array<int, 3>, 3> edges = {{{0, 2, 1}, {1, 0, 2}, {2, 1, 0}}};
    for (const auto& [along, fast, slow] : edges)
        for (double s : {-1.0, 1.0})
            for (double f : {-1.0, 1.0})
                for (double at : {-1.0 / 3, 1.0 / 3})
                {
                    Vec3 node;
                    node[along] = at;
                    node[fast] = f;
                    node[slow] = s;
                    nodes.push_back(node);
                }
    write(one);
    write(32 * cells);
    for (unsigned k = 0; k < field.m_cells; ++k)
        for (unsigned j = 0; j < field.m_cells; ++j)
            for (unsigned i = 0; i < field.m_cells; ++i)
                for (const Vec3& node : nodes)
                {
                    Vec3 x;
                    const std::array<unsigned, 3> at = {i, j, k};
                    for (int c = 0; c < 3; ++c)
                        x[c] = -half[c] + (at[static_cast<std::size_t>(c)] + 0.5 * (node[c] + 1)) * cell[c];
                    write(field.m_distance(x));
                }
    write(one);
    write(cells);
    for (std::uint32_t n = 0; n < 32 * cells; ++n) write(n);
    write(one);
    write(cells);
    for (std::uint32_t n = 0; n < cells; ++n) write(n);
    return file;
}

/// A btSdfCollisionShape of the sampled field.
inline btSdfCollisionShape* makeSdf(const SampledField& field)
{
    const std::vector<char> file = sdfFile(field);
    auto* shape = new btSdfCollisionShape;
    shape->initializeSDF(file.data(), static_cast<int>(file.size()));
    return shape;
}

inline double boxField(const Vec3& x, const Vec3& half)
{
    Vec3 outside;
    double inside = -1e30;
    for (int c = 0; c < 3; ++c)
    {
        const double d = std::abs(x[c]) - half[c];
        outside[c] = std::max(d, 0.0);
        inside = std::max(inside, d);
    }
    return norm(outside) + std::min(inside, 0.0);
}

}  // namespace bullet_fem
