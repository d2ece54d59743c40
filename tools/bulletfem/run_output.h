// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bullet_fem/io/glb_film.h"
#include "bullet_fem/io/vtu_writer.h"
#include "tools/bulletfem/split_film.h"
#include "tools/scene/scene_frames.h"
#ifdef BULLETFEM_HAS_PICTURES
#include "tools/scene/scene_painter.h"
#endif

namespace bullet_fem
{

#ifdef BULLETFEM_HAS_PICTURES
class OffscreenRenderer;
#endif

/// Output files of a run.
struct RunOutputSettings
{
    std::string m_folder;              ///< of all files, created if missing
    bool m_pvd = false;                ///< elements.pvd and surfaces.pvd
    bool m_glb = false;                ///< run.glb
    bool m_png = false;                ///< first.png, last.png and strip.png
    std::vector<std::string> m_films;  ///< file names in the folder, .mp4 or .gif
};

/// Writes a scene's frames during the run, and files that need all frames at its end.
class RunOutput
{
public:
    /// Both must outlive this object. Throws std::runtime_error if the folder or a file in it cannot be created, or
    /// pictures are requested but unavailable.
    RunOutput(const RunOutputSettings& settings, const SceneWorld& world, const SceneFrames& frames);
    ~RunOutput();

    /// Adds the present frames.
    void add();
    /// Draws pictures, which may take longer than the run, and closes films. `progress` receives the completed
    /// fraction. Returns the names of the files written.
    std::vector<std::string> finish(const std::function<void(double)>& progress);
    int frameCount() const { return m_frameCount; }

private:
    void checkFiles() const;
    void drawPictures(std::vector<std::string>& written, const std::function<void(double)>& progress);
    bool drawsPictures() const { return m_settings.m_png || !m_settings.m_films.empty(); }
    std::string path(const std::string& name) const { return m_settings.m_folder + "/" + name; }

    RunOutputSettings m_settings;
    const SceneWorld& m_world;
    const SceneFrames& m_frames;
    std::unique_ptr<VtuSeries> m_elements, m_surfaces;
    std::unique_ptr<GlbFilm> m_film;
    std::unique_ptr<SplitFilm> m_splitFilm;  // replaces m_film if a body may split
#ifdef BULLETFEM_HAS_PICTURES
    std::unique_ptr<OffscreenRenderer> m_renderer;
    std::unique_ptr<ScenePainter> m_painter;
    std::vector<SceneSnapshot> m_snapshots;
#endif
    int m_frameCount = 0;
};

}  // namespace bullet_fem
