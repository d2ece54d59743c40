// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemRay.h"
#include "python/core/handles.h"

namespace bullet_fem::python
{
namespace
{

py::dict hitOf(int body, double fraction, const btVector3& point, const btVector3& normal)
{
    py::dict hit;
    hit["body"] = body;
    hit["fraction"] = fraction;
    hit["point"] = arrayOf(point);
    hit["normal"] = arrayOf(normal);
    hit["nodes"] = arrayOf(std::vector<int>());
    hit["weights"] = Doubles(0);
    return hit;
}

py::dict hitOf(int body, const btFemRayHit& from)
{
    py::dict hit = hitOf(body, from.m_fraction, from.m_point, from.m_normal);
    hit["nodes"] = arrayOf(std::vector<int>(from.m_nodes, from.m_nodes + 3));
    hit["weights"] = arrayOf(btVector3(from.m_weights[0], from.m_weights[1], from.m_weights[2]));
    return hit;
}

py::object testBody(const SoftHandle& self, py::handle start, py::handle end)
{
    btFemRayHit hit;
    if (!btFemRay::test(&self.body(), vectorOf(start, "start"), vectorOf(end, "end"), &hit)) return py::none();
    return hitOf(self.m_index, hit);
}

py::object testWorld(World& world, py::handle start, py::handle end)
{
    world.guard().reading();
    const btVector3 from = vectorOf(start, "start"), to = vectorOf(end, "end");
    if ((to - from).fuzzyZero()) throw py::value_error("end equals start: a ray needs a length");
    btFemClosestRay ray(from, to);
    world.bullet().world().rayTest(from, to, ray);
    if (!ray.hasHit()) return py::none();
    const int body = world.bodies().indexOf(ray.m_collisionObject);
    if (ray.m_hit.m_nodes[0] >= 0) return hitOf(body, ray.m_hit);
    return hitOf(body, ray.m_closestHitFraction, ray.m_hitPointWorld, ray.m_hitNormalWorld);
}

}  // namespace

void bindRays(SoftClass& body, WorldClass& world)
{
    const char* text =
        "First hit of a ray between two points (3,) [m], or None: a dict of body (index), fraction [-], point (3,) "
        "[m],\n"
        "normal (3,) [-], and of a soft body the nodes of the triangle (3,) and their weights (3,).";
    body.def("ray_test", &testBody, py::arg("start"), py::arg("end"), text);
    world.def("ray_test", &testWorld, py::arg("start"), py::arg("end"), text);
}

}  // namespace bullet_fem::python
