// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/carrying_planes.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "bullet_bridge/geometry/surface/triangle_proximity.h"

namespace bullet_fem
{
namespace
{

constexpr int kFewest = 3;             // smallest number of contacts on the face
constexpr double kCarriedShare = 0.8;  // smallest share of the normal impulses that the face or side carries

}  // namespace

CarryingPlanes::CarryingPlanes(double oneFaceCosine) : m_oneFaceCosine(oneFaceCosine)
{
    constexpr int kObjects = 32;  // for which no step allocates
    m_carried.reserve(kObjects);
}

void CarryingPlanes::find()
{
    m_order.reserve(m_pushes.capacity());
    m_order.resize(m_pushes.size());
    std::iota(m_order.begin(), m_order.end(), 0);
    const auto key = [&](int k) { return std::make_tuple(m_pushes[k].m_objectId, k); };
    std::sort(m_order.begin(), m_order.end(), [&](int a, int b) { return key(a) < key(b); });
    m_carried.clear();
    for (std::size_t first = 0, end = 0; first < m_order.size(); first = end)
    {
        const int id = m_pushes[m_order[first]].m_objectId;
        while (end < m_order.size() && m_pushes[m_order[end]].m_objectId == id) ++end;
        m_carried.push_back({id, {}, {}, sideOf(first, end)});
        findPlane(first, end, m_carried.back());
    }
}

// The plane of one object's pushes, a range of m_order.
void CarryingPlanes::findPlane(std::size_t first, std::size_t end, Carried& carried) const
{
    CarryingPlane& plane = carried.m_plane;
    double sum = 0, largest = 0, onFace = 0;
    int count = 0;
    Vec3 normal, foot, main;
    for (std::size_t k = first; k < end; ++k)
    {
        const Push& push = m_pushes[m_order[k]];
        sum += push.m_size;
        if (push.m_size <= largest) continue;
        largest = push.m_size;
        main = push.m_normal;
    }
    for (std::size_t k = first; k < end; ++k)
    {
        const Push& push = m_pushes[m_order[k]];
        if (dot(push.m_normal, main) < m_oneFaceCosine) continue;
        ++count;
        onFace += push.m_size;
        normal += push.m_size * push.m_normal;
        foot += push.m_size * push.m_foot;
    }
    plane.m_exists = count >= kFewest && onFace >= kCarriedShare * sum;
    if (!plane.m_exists) return;
    plane.m_normal = (1 / norm(normal)) * normal;
    carried.m_foot = (1 / onFace) * foot;
    plane.m_distance = dot(plane.m_normal, carried.m_foot);
}

// The side of one object's pushes, a range of m_order.
CarryingSide CarryingPlanes::sideOf(std::size_t first, std::size_t end) const
{
    double sum = 0;
    Vec3 all, momentum;
    for (std::size_t k = first; k < end; ++k)
    {
        const Push& push = m_pushes[m_order[k]];
        sum += push.m_size;
        all += push.m_size * push.m_normal;
        momentum += push.m_size * push.m_velocity;
    }
    const double size = norm(all);
    if (!(size > 0) || size < kCarriedShare * sum) return {};
    return {true, (1 / size) * all, (1 / sum) * momentum};
}

const CarryingPlanes::Carried* CarryingPlanes::find(int objectId) const
{
    const auto at = std::lower_bound(m_carried.begin(), m_carried.end(), objectId,
                                     [](const Carried& carried, int id) { return carried.m_objectId < id; });
    return at == m_carried.end() || at->m_objectId != objectId ? nullptr : &*at;
}

CarryingPlane CarryingPlanes::planeOf(int objectId, const RigidMotion& motion, double step) const
{
    const Carried* carried = find(objectId);
    if (!carried) return {};
    CarryingPlane plane = carried->m_plane;
    const Vec3 turn = step * motion.m_angularVelocity, way = step * motion.m_linearVelocity;
    const Vec3 arm = carried->m_foot - (motion.m_center - way);
    plane.m_normal = unit(plane.m_normal + cross(turn, plane.m_normal));
    plane.m_distance = dot(plane.m_normal, carried->m_foot + way + cross(turn, arm));
    return plane;
}

CarryingSide CarryingPlanes::sideOf(int objectId) const
{
    const Carried* carried = find(objectId);
    return carried ? carried->m_side : CarryingSide();
}

}  // namespace bullet_fem
