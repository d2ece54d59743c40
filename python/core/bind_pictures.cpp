// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/handles.h"
#ifdef BULLETFEM_HAS_PICTURES
#include <unistd.h>

#include <algorithm>

#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "BulletCollision/CollisionShapes/btShapeHull.h"
#include "bullet_fem/btFemVectors.h"
#include "python/core/world_robots.h"
#include "tools/pictures/offscreen_renderer.h"
#endif

namespace bullet_fem::python
{
#ifdef BULLETFEM_HAS_PICTURES
namespace
{

constexpr int kMaxPixels = 8192;  // of a side

PictureMesh meshOf(const btSoftBody& body)
{
    PictureMesh mesh;
    if (body.m_renderFaces.size() > 0)
    {
        for (int i = 0; i < body.m_renderNodes.size(); ++i) mesh.m_positions.push_back(vec3(body.m_renderNodes[i].m_x));
        for (int i = 0; i < body.m_renderFaces.size(); ++i)
        {
            Triangle triangle;
            for (int k = 0; k < 3; ++k) triangle[k] = int(body.m_renderFaces[i].m_n[k] - &body.m_renderNodes[0]);
            mesh.m_triangles.push_back(triangle);
        }
        return mesh;
    }
    for (int i = 0; i < body.m_nodes.size(); ++i) mesh.m_positions.push_back(vec3(body.m_nodes[i].m_x));
    for (int i = 0; i < body.m_faces.size(); ++i)
    {
        Triangle triangle;
        for (int k = 0; k < 3; ++k) triangle[k] = int(body.m_faces[i].m_n[k] - &body.m_nodes[0]);
        mesh.m_triangles.push_back(triangle);
    }
    return mesh;
}

void addStress(PictureMesh& mesh, const btFemSoftBodySolver& fem, const btSoftBody& body, double& hottest)
{
    btAlignedObjectArray<btScalar> values;
    if (body.m_renderFaces.size() > 0 || !fem.getNodeVonMises(&body, values)) return;
    for (int i = 0; i < values.size(); ++i) mesh.m_scalars.push_back(values[i]);
    std::vector<double> sorted = mesh.m_scalars;
    const auto quantile = sorted.begin() + long(0.98 * double(sorted.size()));
    std::nth_element(sorted.begin(), quantile, sorted.end());
    hottest = std::max(hottest, *quantile);
}

// The hulls of a link's shapes.
PictureMesh meshOf(const btMultiBodyLinkCollider& link)
{
    PictureMesh mesh;
    mesh.m_colour = {0.55, 0.60, 0.68};
    const auto& compound = static_cast<const btCompoundShape&>(*link.getCollisionShape());
    for (int k = 0; k < compound.getNumChildShapes(); ++k)
    {
        btShapeHull hull(static_cast<const btConvexShape*>(compound.getChildShape(k)));
        hull.buildHull(0, 1);
        const btTransform pose = link.getWorldTransform() * compound.getChildTransform(k);
        const int first = int(mesh.m_positions.size());
        for (int i = 0; i < hull.numVertices(); ++i)
            mesh.m_positions.push_back(vec3(pose * hull.getVertexPointer()[i]));
        for (int i = 0; i < hull.numTriangles(); ++i)
        {
            Triangle triangle;
            for (int a = 0; a < 3; ++a) triangle[a] = first + int(hull.getIndexPointer()[3 * i + a]);
            mesh.m_triangles.push_back(triangle);
        }
    }
    return mesh;
}

PictureScene sceneOf(World& world, bool stress)
{
    PictureScene scene;
    double hottest = 1;
    scene.m_ground.m_shown = false;
    for (const BodyEntry& body : world.bodies())
    {
        if (body.m_soft)
        {
            scene.m_meshes.push_back(meshOf(*body.m_soft->m_body));
            if (stress) addStress(scene.m_meshes.back(), world.fem(), *body.m_soft->m_body, hottest);
        }
        if (!body.m_rigid) continue;
        const btTransform& pose = body.m_rigid->m_body->getWorldTransform();
        const SurfaceMesh& drawn = body.m_rigid->m_shape->drawn();
        if (body.m_rigid->m_body->getCollisionShape()->getShapeType() == STATIC_PLANE_PROXYTYPE)
        {
            const auto* plane = static_cast<const btStaticPlaneShape*>(body.m_rigid->m_body->getCollisionShape());
            scene.m_ground.m_shown = true;
            scene.m_ground.m_point = vec3(pose.getOrigin());
            scene.m_ground.m_normal = vec3(pose.getBasis() * plane->getPlaneNormal());
        }
        if (drawn.m_triangles.empty()) continue;
        PictureMesh mesh;
        mesh.m_colour = {0.55, 0.60, 0.68};
        mesh.m_triangles = drawn.m_triangles;
        for (const Vec3& vertex : drawn.m_vertices) mesh.m_positions.push_back(vec3(pose * bulletVector(vertex)));
        scene.m_meshes.push_back(std::move(mesh));
    }
    for (int k = 0; k < WorldRobots::count(world); ++k)
    {
        Robot& robot = WorldRobots::robot(world, k);
        for (int link = 0; link < robot.linkCount(); ++link)
        {
            PictureMesh mesh = meshOf(robot.collider(link));
            if (!mesh.m_triangles.empty()) scene.m_meshes.push_back(std::move(mesh));
        }
    }
    scene.m_colourScale = {0, hottest, "von Mises stress", "Pa", true};
    return scene;
}

PictureCamera cameraOf(World& world, const PictureScene& scene, py::handle eye, py::handle target,
                       const PictureSize& size)
{
    const btVector3 gravity = world.bullet().info().m_gravity;
    const Vec3 up = gravity.fuzzyZero() ? Vec3{0, 1, 0} : vec3(-gravity.normalized());
    if (eye.is_none()) return framing(scene, {1, 0.6, 1.6}, up, size);
    PictureCamera camera;
    camera.m_eye = vec3(vectorOf(eye, "eye"));
    camera.m_target = target.is_none() ? bounds(scene).centre() : vec3(vectorOf(target, "target"));
    camera.m_up = up;
    return camera;
}

/// The renderer of the process, which is never deleted: the driver may be gone before.
OffscreenRenderer& renderer()
{
    static OffscreenRenderer* renderer = nullptr;
    static pid_t process = 0;
    if (!renderer)
    {
        renderer = new OffscreenRenderer;
        process = getpid();
    }
    if (process != getpid())
        throw std::runtime_error(
            "this process was forked from one that drew pictures, whose driver does not survive a fork: start "
            "processes by "
            "multiprocessing.get_context('spawn')");
    return *renderer;
}

py::array_t<unsigned char> render(World& world, int width, int height, py::handle eye, py::handle target, bool stress)
{
    world.guard().reading();
    if (width < 1 || width > kMaxPixels || height < 1 || height > kMaxPixels)
        throw py::value_error("width and height must be in [1, " + std::to_string(kMaxPixels) + "]");
    PictureScene scene = sceneOf(world, stress);
    const PictureSize size{width, height};
    scene.m_camera = cameraOf(world, scene, eye, target, size);
    const Image image = renderer().render(scene, size);
    py::array_t<unsigned char> pixels(Dims{height, width, 3});
    std::copy(image.m_pixels.begin(), image.m_pixels.end(), pixels.mutable_data());
    return pixels;
}

}  // namespace

void bindPictures(WorldClass& world)
{
    world.def(
        "render", &render, py::arg("width") = 960, py::arg("height") = 540, py::kw_only(), py::arg("eye") = py::none(),
        py::arg("target") = py::none(), py::arg("stress") = false,
        "A picture of the world, uint8 (height, width, 3), seen from `eye` (3,) to `target` (3,) [m], or so that all\n"
        "bodies are seen; `stress` colours soft bodies by von Mises stress. Needs EGL, but no display.");
}
#else
void bindPictures(WorldClass& world)
{
    world.def("render",
              [](World&, const py::args&, const py::kwargs&) -> py::object
              {
                  throw std::runtime_error(
                      "this module was built without pictures: install libepoxy-dev, libegl-dev, libstb-dev and "
                      "fonts-dejavu-core, and build it again");
              });
}
#endif

}  // namespace bullet_fem::python
