// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/bulletfem/run_output.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "fem/common/output_file.h"
#ifdef BULLETFEM_HAS_PICTURES
#include "tools/pictures/film_writer.h"
#include "tools/pictures/offscreen_renderer.h"
#endif

namespace bullet_fem
{
namespace
{

constexpr int kStripFrames = 4, kStripGap = 8;  // [pixels]
const char* const kGlbName = "run.glb";
const std::array<const char*, 3> kPngNames = {"first.png", "last.png", "strip.png"};

GlbSettings glbSettings(const SceneWorld& world)
{
    const SceneDescription& scene = world.description();
    GlbSettings settings;
    settings.m_normals = !SplitFilm::isNeeded(world);  // smoothed normals would show cracks before they open
    if (scene.m_pictures.m_stress) settings.m_colours = GlbColours::peakVonMises;
    settings.m_hottest = scene.m_pictures.m_hottest;
    settings.m_maxFrames = 65535;
    return settings;
}

}  // namespace

RunOutput::RunOutput(const RunOutputSettings& settings, const SceneWorld& world, const SceneFrames& frames)
    : m_settings(settings), m_world(world), m_frames(frames)
{
    std::error_code error;
    std::filesystem::create_directories(settings.m_folder, error);
    if (error) throw std::runtime_error("cannot make the folder '" + settings.m_folder + "': " + error.message());
    checkFiles();
    if (settings.m_pvd)
    {
        m_elements = std::make_unique<VtuSeries>(settings.m_folder, "elements", VtuEncoding::compressed);
        m_surfaces = std::make_unique<VtuSeries>(settings.m_folder, "surfaces", VtuEncoding::compressed);
    }
    if (settings.m_glb) m_film = std::make_unique<GlbFilm>(glbSettings(world));
    if (settings.m_glb && SplitFilm::isNeeded(world)) m_splitFilm = std::make_unique<SplitFilm>(world, frames);
    if (!drawsPictures()) return;
#ifdef BULLETFEM_HAS_PICTURES
    if (!settings.m_films.empty() && !FilmWriter::available())
        throw std::runtime_error("a film needs the program ffmpeg, which is not found: install the package ffmpeg");
    m_renderer = std::make_unique<OffscreenRenderer>();
    m_painter = std::make_unique<ScenePainter>(world, frames);
#else
    throw std::runtime_error(
        "this program was built without pictures: install what docs/pictures.md names, and build it anew");
#endif
}

RunOutput::~RunOutput() = default;

// Checks before the run that the files of its end can be written.
void RunOutput::checkFiles() const
{
    if (m_settings.m_glb) checkWritable(path(kGlbName));
    for (const char* name : kPngNames)
        if (m_settings.m_png) checkWritable(path(name));
    for (const std::string& name : m_settings.m_films) checkWritable(path(name));
}

void RunOutput::add()
{
    ++m_frameCount;
    if (m_elements && !m_frames.volumes().empty()) m_elements->writeBodies(m_world.time(), m_frames.volumes());
    if (m_surfaces && !m_frames.surfaces().empty()) m_surfaces->writeBodies(m_world.time(), m_frames.surfaces());
    if (m_splitFilm)
        m_splitFilm->add();
    else if (m_film && !m_frames.surfaces().empty())
        m_film->addFrame(m_world.time(), m_frames.surfaces());
#ifdef BULLETFEM_HAS_PICTURES
    if (m_painter) m_snapshots.push_back(snapshotOf(m_world, m_frames));
#endif
}

std::vector<std::string> RunOutput::finish(const std::function<void(double)>& progress)
{
    std::vector<std::string> written;
    for (const auto* series : {&m_elements, &m_surfaces})
        if (*series && (*series)->frameCount() > 0) written.push_back((*series)->pvdPath());
    if (m_splitFilm) m_splitFilm->give(*m_film);
    if (m_film && m_film->frameCount() > 0)
    {
        m_film->write(path(kGlbName));
        written.push_back(path(kGlbName));
    }
    if (drawsPictures()) drawPictures(written, progress);
    return written;
}

#ifdef BULLETFEM_HAS_PICTURES
void RunOutput::drawPictures(std::vector<std::string>& written, const std::function<void(double)>& progress)
{
    const ScenePictures& pictures = m_world.description().m_pictures;
    const PictureSize size = {pictures.m_width, pictures.m_height};
    const int count = static_cast<int>(m_snapshots.size());
    if (pictures.m_hottest <= 0) m_painter->setHottest(hottestOf(m_snapshots));
    if (const double largest = largestForceOf(m_snapshots); largest > 0) m_painter->setLargestForce(largest);
    std::vector<std::unique_ptr<FilmWriter>> films;
    const SceneDescription& scene = m_world.description();
    const double perSecond = std::min(scene.m_framesPerSecond, 1 / scene.m_step);  // at most one frame per step
    const int rate = static_cast<int>(std::clamp(std::round(perSecond), 1.0, 100.0));
    for (const std::string& name : m_settings.m_films)
        films.push_back(std::make_unique<FilmWriter>(path(name), size, rate));
    std::vector<Image> strip;
    const int inAll = std::min(count, kStripFrames);
    for (int k = 0; k < count; ++k)
    {
        const int place = static_cast<int>(strip.size());
        const bool inStrip = m_settings.m_png && place < inAll && k == place * (count - 1) / std::max(1, inAll - 1);
        if (!inStrip && films.empty()) continue;
        const Image image = m_renderer->render(m_painter->paint(m_snapshots[k]), size);
        for (const auto& film : films) film->append(image);
        if (inStrip) strip.push_back(image);
        progress(double(k + 1) / count);
    }
    for (std::size_t i = 0; i < films.size(); ++i)
    {
        films[i]->finish();
        written.push_back(path(m_settings.m_films[i]));
    }
    if (strip.empty()) return;
    writePng(strip.front(), path(kPngNames[0]));
    writePng(strip.back(), path(kPngNames[1]));
    writePng(besideEachOther(strip, kStripGap), path(kPngNames[2]));
    for (const char* name : kPngNames) written.push_back(path(name));
}
#else
void RunOutput::drawPictures(std::vector<std::string>&, const std::function<void(double)>&) {}
#endif

}  // namespace bullet_fem
