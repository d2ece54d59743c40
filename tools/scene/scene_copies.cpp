// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_copies.h"

#include <array>
#include <cmath>
#include <random>

namespace bullet_fem
{
namespace
{

constexpr int kMaxAlongAnAxis = 100, kMaxCopies = 10000;  // of a grid [-]
constexpr double kFarthest = 1e6;                         // largest coordinate of a position, as for all bodies [m]

std::array<int, 3> readCount(const JsonCursor& at)
{
    const std::vector<JsonCursor> items = at.items();
    if (items.size() != 3) at.expected("an array of three whole numbers");
    std::array<int, 3> count;
    for (std::size_t i = 0; i < 3; ++i) count[i] = items[i].integer(1, kMaxAlongAnAxis);
    const int bodies = count[0] * count[1] * count[2];
    if (bodies > kMaxCopies)
        at.fail("makes " + std::to_string(bodies) + " bodies; at most " + std::to_string(kMaxCopies) + " are allowed");
    return count;
}

// A uniformly distributed random rotation by a quaternion [Shoemake 1992].
void turn(std::mt19937& random, ScenePose& pose)
{
    constexpr double kTwoPi = 6.283185307179586;
    const auto share = [&] { return (double(random()) + 0.5) / 4294967296.0; };  // uniform in (0, 1), in steps of 2^-32
    const double s = share(), a = kTwoPi * share(), b = kTwoPi * share();
    const Vec3 axis = {std::sqrt(1 - s) * std::sin(a), std::sqrt(1 - s) * std::cos(a), std::sqrt(s) * std::sin(b)};
    if (norm(axis) > 0) pose.m_axis = axis;
    pose.m_angle = 2 * std::atan2(norm(axis), std::sqrt(s) * std::cos(b));
}

}  // namespace

std::vector<ScenePose> readCopies(const JsonCursor& at, const ScenePose& first)
{
    at.onlyMembers({"count", "spacing", "turned"});
    const std::array<int, 3> count = readCount(at["count"]);
    const Vec3 spacing = at["spacing"].vector({-kFarthest, kFarthest});
    for (int i = 0; i < 3; ++i)
        if (std::abs(first.m_position[i] + (count[i] - 1) * spacing[i]) > kFarthest)
            at["spacing"].fail("puts the last copy beyond 1e6 m; make it or 'count' smaller");
    bool turned = false;
    at.read("turned", turned);
    std::mt19937 random;
    std::vector<ScenePose> poses;
    for (int k = 0; k < count[2]; ++k)
        for (int j = 0; j < count[1]; ++j)
            for (int i = 0; i < count[0]; ++i)
            {
                poses.push_back(first);
                poses.back().m_position += Vec3{i * spacing.x, j * spacing.y, k * spacing.z};
                if (turned) turn(random, poses.back());
            }
    return poses;
}

}  // namespace bullet_fem
