// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/compare/compared_film.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#ifdef BULLETFEM_HAS_PICTURES
#include "tools/pictures/film_writer.h"
#include "tools/pictures/offscreen_renderer.h"
#endif

namespace bullet_fem
{

#ifdef BULLETFEM_HAS_PICTURES

namespace
{

constexpr PictureSize kHalf{398, 450}, kFilm{800, 450};
constexpr int kGap = 4, kStripFrames = 6, kStripGap = 8;  // [pixels]
constexpr int kFramesPerSecond = 60 / kStepsPerFrame;
constexpr double kTextSize = 1.8;

bool isFinite(const std::vector<Vec3>& positions)
{
    return std::all_of(positions.begin(), positions.end(), [](const Vec3& x) { return norm(x) < 1e6; });
}

/// The scene without bodies that have left all bounds, as Bullet's own may.
PictureScene pictureOf(const ComparedScene& scene, const ComparedRun& run, std::size_t frame, const ComparedText& text)
{
    PictureScene picture;
    const std::vector<BodyFrame>& bodies = run.m_frames[frame];
    for (std::size_t k = 1; k < bodies.size(); ++k)  // the first is the ground
    {
        if (!isFinite(bodies[k].m_positions)) continue;
        PictureMesh mesh;
        mesh.m_positions = bodies[k].m_positions;
        mesh.m_triangles = bodies[k].m_triangles;
        const Vec3& colour = run.m_colours[k];
        mesh.m_colour = {colour.x, colour.y, colour.z};
        picture.m_meshes.push_back(std::move(mesh));
    }
    const double half = 0.5 * norm(scene.m_eye - scene.m_target);
    picture.m_bounds = PictureBounds{scene.m_target - Vec3{half, half, half}, scene.m_target + Vec3{half, half, half}};
    picture.m_ground.m_gridSpacing = 0.5;
    picture.m_camera.m_eye = scene.m_eye;
    picture.m_camera.m_target = scene.m_target;
    picture.m_camera.m_fieldOfView = scene.m_fieldOfView;
    picture.m_textSize = kTextSize;
    picture.m_title = text.m_title;
    picture.m_caption = text.m_figures;
    return picture;
}

}  // namespace

struct ComparedFilm::Pictures
{
    OffscreenRenderer m_renderer;
    std::unique_ptr<FilmWriter> m_film;
    std::vector<std::string> m_written;
};

ComparedFilm::ComparedFilm(const std::string& folder) : m_folder(folder), m_pictures(std::make_unique<Pictures>())
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw std::runtime_error("cannot make the folder '" + folder + "': " + error.message());
    if (FilmWriter::available())
        m_pictures->m_film = std::make_unique<FilmWriter>(folder + "/film.mp4", kFilm, kFramesPerSecond);
}

void ComparedFilm::add(const ComparedScene& scene, const ComparedRun& left, const ComparedText& leftText,
                       const ComparedRun& right, const ComparedText& rightText)
{
    std::vector<Image> strip;
    const std::size_t count = left.m_frames.size();
    for (std::size_t k = 0; k < count; ++k)
    {
        const bool inStrip = k == strip.size() * (count - 1) / (kStripFrames - 1);
        if (!m_pictures->m_film && !inStrip) continue;
        const Image both =
            besideEachOther({m_pictures->m_renderer.render(pictureOf(scene, left, k, leftText), kHalf),
                             m_pictures->m_renderer.render(pictureOf(scene, right, k, rightText), kHalf)},
                            kGap);
        if (m_pictures->m_film) m_pictures->m_film->append(both);
        if (inStrip) strip.push_back(both);
    }
    const std::string path = m_folder + "/" + scene.m_name + ".png";
    writePng(besideEachOther(strip, kStripGap), path);
    m_pictures->m_written.push_back(path);
}

std::vector<std::string> ComparedFilm::finish()
{
    if (m_pictures->m_film)
    {
        m_pictures->m_film->finish();
        m_pictures->m_written.push_back(m_folder + "/film.mp4");
    }
    return m_pictures->m_written;
}

#else

struct ComparedFilm::Pictures
{
};

ComparedFilm::ComparedFilm(const std::string&)
{
    throw std::runtime_error("--out: this program was built without pictures; install what docs/pictures.md names");
}

void ComparedFilm::add(const ComparedScene&, const ComparedRun&, const ComparedText&, const ComparedRun&,
                       const ComparedText&)
{
}

std::vector<std::string> ComparedFilm::finish()
{
    return {};
}

#endif

ComparedFilm::~ComparedFilm() = default;

}  // namespace bullet_fem
