// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bullet_fem/io/vtu_writer.h"
#include "demos/common/demo_surfaces.h"

namespace bullet_fem
{

/// Output files of a demo: a ParaView series of all surfaces (surfaces.pvd), three pictures (first.png, middle.png,
/// last.png) and, if ffmpeg is found, a film (film.mp4). A program built without the renderer writes the series alone.
class DemoFilm
{
public:
    DemoFilm();
    ~DemoFilm();
    DemoFilm(const DemoFilm&) = delete;
    DemoFilm& operator=(const DemoFilm&) = delete;

    /// Starts recording frames of a run of `seconds` [s]. Throws std::runtime_error if the folder cannot be written.
    void open(const std::string& folder, double seconds);

    void look(const btVector3& eye, const btVector3& target, double fieldOfView);
    /// Also draws the objects of another world; null: of none.
    void drawBeside(const btDynamicsWorld* world) { m_beside = world; }
    void paint(const btCollisionObject& object, const Vec3& colour) { m_colours[&object] = colour; }

    /// Draws the world at `time` [s] if recording has started and the next frame is due. Throws std::runtime_error.
    void show(const btDynamicsWorld& world, double time);

    /// Ends the film. Returns the names of the files written.
    std::vector<std::string> finish();

private:
    struct Pictures;
    Vec3 colourOf(const btCollisionObject& object, int soft) const;
    void draw();
    std::string path(const char* name) const { return m_folder + "/" + name; }

    std::string m_folder;
    double m_seconds = 0, m_framesPerSecond = 0;
    int m_frames = 0;
    DemoSurfaces m_surfaces;
    std::unique_ptr<VtuSeries> m_series;
    std::map<const btCollisionObject*, Vec3> m_colours;
    const btDynamicsWorld* m_beside = nullptr;
    btVector3 m_eye{3, 2, 4}, m_target{0, 0, 0};
    double m_fieldOfView = 0.6;
    std::unique_ptr<Pictures> m_pictures;
};

}  // namespace bullet_fem
