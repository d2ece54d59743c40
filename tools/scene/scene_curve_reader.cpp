// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_curve_reader.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

template <class Value, class ReadValue>
SceneCurveOf<Value> readPairs(const JsonCursor& at, const ReadValue& readValue)
{
    using Point = typename SceneCurveOf<Value>::Point;
    SceneCurveOf<Value> curve;
    for (const JsonCursor& item : at.items())
    {
        const std::vector<JsonCursor> pair = item.items();
        if (pair.size() != 2) item.expected("a pair [seconds, value]");
        curve.m_points.push_back({pair[0].number({0, 1e30}), readValue(pair[1])});
    }
    std::stable_sort(curve.m_points.begin(), curve.m_points.end(),
                     [](const Point& a, const Point& b) { return a.m_time < b.m_time; });
    return curve;
}

}  // namespace

SceneCurve readCurve(const JsonCursor& at, const JsonRange& range)
{
    if (!at.isArray()) return {{{0, at.number(range)}}};
    SceneCurve curve = readPairs<double>(at, [&](const JsonCursor& value) { return value.number(range); });
    if (curve.m_points.empty()) at.expected("a number, or pairs [seconds, value]");
    return curve;
}

SceneVectorCurve readVectorCurve(const JsonCursor& at, const JsonRange& range)
{
    if (!isVectorCurve(at)) return {{{0, at.vector(range)}}};
    return readPairs<Vec3>(at, [&](const JsonCursor& value) { return value.vector(range); });
}

bool isVectorCurve(const JsonCursor& at)
{
    return at.isArray() && !at.items().empty() && at.items().front().isArray();
}

}  // namespace bullet_fem
