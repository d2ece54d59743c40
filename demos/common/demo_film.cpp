// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/common/demo_film.h"

#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemVectors.h"
#include "demos/common/demo.h"
#ifdef BULLETFEM_HAS_PICTURES
#include "tools/pictures/film_writer.h"
#include "tools/pictures/offscreen_renderer.h"
#endif

namespace bullet_fem
{
namespace
{

constexpr double kMaxFrames = 72, kMaxFramesPerSecond = 20;
const Vec3 kSoftColours[] = {{0.86, 0.52, 0.30}, {0.33, 0.62, 0.58}, {0.85, 0.70, 0.32},
                             {0.73, 0.38, 0.42}, {0.42, 0.55, 0.76}, {0.58, 0.70, 0.38}};
const Vec3 kRigidColour{0.55, 0.60, 0.68}, kStaticColour{0.70, 0.71, 0.73};

}  // namespace

#ifdef BULLETFEM_HAS_PICTURES

struct DemoFilm::Pictures
{
    static constexpr PictureSize kFilmSize{960, 540}, kPictureSize{1280, 720};
    OffscreenRenderer m_renderer;
    std::unique_ptr<FilmWriter> m_film;
    PictureScene m_scene;
};

void DemoFilm::draw()
{
    PictureScene& scene = m_pictures->m_scene;
    scene.m_meshes.clear();
    int soft = 0;
    for (std::size_t k = 0; k < m_surfaces.frames().size(); ++k)
    {
        const btCollisionObject& object = *m_surfaces.objects()[k];
        PictureMesh mesh;
        mesh.m_positions = m_surfaces.frames()[k].m_positions;
        mesh.m_triangles = m_surfaces.frames()[k].m_triangles;
        const Vec3 colour = colourOf(object, soft);
        if (btSoftBody::upcast(&object)) ++soft;
        mesh.m_colour = {colour.x, colour.y, colour.z};
        scene.m_meshes.push_back(std::move(mesh));
    }
    // Shadows are computed for a box around the camera's target. The camera keeps its distance, so that their softness
    // is constant.
    const btScalar half = btScalar(0.5) * (m_eye - m_target).length();
    scene.m_bounds = PictureBounds{vec3(m_target - at(half, half, half)), vec3(m_target + at(half, half, half))};
    scene.m_ground.m_shown = m_surfaces.ground() != nullptr;
    if (scene.m_ground.m_shown)
    {
        const auto* plane = static_cast<const btStaticPlaneShape*>(m_surfaces.ground()->getCollisionShape());
        scene.m_ground.m_normal = vec3(plane->getPlaneNormal());
        scene.m_ground.m_point =
            vec3(m_surfaces.ground()->getWorldTransform() * (plane->getPlaneNormal() * plane->getPlaneConstant()));
        scene.m_ground.m_gridSpacing = std::pow(10, std::floor(std::log10(scene.m_bounds->radius())));
    }
    scene.m_camera.m_eye = vec3(m_eye);
    scene.m_camera.m_target = vec3(m_target);
    scene.m_camera.m_fieldOfView = m_fieldOfView;
    if (m_pictures->m_film) m_pictures->m_film->append(m_pictures->m_renderer.render(scene, Pictures::kFilmSize));
    const char* names[] = {"first.png", "middle.png", "last.png"};
    const double last = std::floor(m_seconds * m_framesPerSecond + 1e-6);
    for (int k = 0; k < 3; ++k)
        if (m_frames == std::floor(0.5 * k * last))
            writePng(m_pictures->m_renderer.render(scene, Pictures::kPictureSize), path(names[k]));
}

#else

struct DemoFilm::Pictures
{
};

void DemoFilm::draw() {}

#endif

DemoFilm::DemoFilm() = default;

DemoFilm::~DemoFilm() = default;

void DemoFilm::open(const std::string& folder, double seconds)
{
    m_folder = folder;
    m_seconds = seconds;
    m_framesPerSecond = std::clamp(std::round(kMaxFrames / seconds), 1.0, kMaxFramesPerSecond);
    m_series = std::make_unique<VtuSeries>(folder, "surfaces", VtuEncoding::compressed);
    m_pictures = std::make_unique<Pictures>();
#ifdef BULLETFEM_HAS_PICTURES
    if (FilmWriter::available())
        m_pictures->m_film =
            std::make_unique<FilmWriter>(path("film.mp4"), Pictures::kFilmSize, static_cast<int>(m_framesPerSecond));
#endif
}

void DemoFilm::look(const btVector3& eye, const btVector3& target, double fieldOfView)
{
    m_eye = eye;
    m_target = target;
    m_fieldOfView = fieldOfView;
}

Vec3 DemoFilm::colourOf(const btCollisionObject& object, int soft) const
{
    const auto known = m_colours.find(&object);
    if (known != m_colours.end()) return known->second;
    if (btSoftBody::upcast(&object)) return kSoftColours[soft % std::size(kSoftColours)];
    return object.isStaticOrKinematicObject() ? kStaticColour : kRigidColour;
}

void DemoFilm::show(const btDynamicsWorld& world, double time)
{
    if (!m_series || time * m_framesPerSecond + 1e-6 < m_frames) return;
    std::vector<const btDynamicsWorld*> worlds = {&world};
    if (m_beside) worlds.push_back(m_beside);
    m_surfaces.update(worlds);
    m_series->writeBodies(time, m_surfaces.frames());
    draw();
    ++m_frames;
}

std::vector<std::string> DemoFilm::finish()
{
    std::vector<std::string> written;
    if (!m_series) return written;
    written.push_back(m_series->pvdPath());
#ifdef BULLETFEM_HAS_PICTURES
    for (const char* name : {"first.png", "middle.png", "last.png"}) written.push_back(path(name));
    if (m_pictures->m_film)
    {
        m_pictures->m_film->finish();
        written.push_back(path("film.mp4"));
    }
#endif
    return written;
}

}  // namespace bullet_fem
