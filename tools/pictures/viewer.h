// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>

#include "tools/pictures/image.h"
#include "tools/pictures/overlay.h"
#include "tools/pictures/viewer_control.h"

namespace bullet_fem
{

/// A window's beginnings.
struct ViewerSettings
{
    std::string m_title = "BulletFEM";
    PictureSize m_size;  ///< of the window; the user can change it
    bool m_paused = false;
    int m_largestCatchUp = 4;        ///< steps a frame at most, when the simulation is slower than the clock
    std::string m_filmFolder = ".";  ///< of films that the user makes
};

/// A window that shows a simulation and lets the user steer it. One at a time in a program, and from its main thread.
class Viewer
{
public:
    /// Opens the window. The simulation must outlive it. Throws std::runtime_error, saying why, where no window can be
    /// opened.
    explicit Viewer(ViewerSimulation& simulation, const ViewerSettings& settings = {});
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    /// Steps in real time and draws, until the user closes the window.
    void run();
    /// Handles what the user did, makes `steps` steps unless paused, and draws. A scene that is not `valid` pauses the
    /// viewer, which says why. `drawnTime` is that of ViewerSimulation::setDrawnTime; 0 while it is paused. False if
    /// the window is to be closed.
    bool frame(int steps = 1, double drawnTime = 0);

    /// As if the user had done it; takes effect in the next frame. Sliders and buttons feel one event a frame.
    void inject(const ViewerEvent& event);
    /// Where the slider of parameter `index` was in the last frame [pixels]; empty if it was not shown.
    PictureRectangle sliderArea(std::size_t index) const;
    /// What the last frame showed, with the panel.
    Image screenshot() const;

    const ViewerControl& control() const;
    /// Of the picture, in pixels.
    PictureSize size() const;

private:
    struct Window;
    struct Parts;
    std::unique_ptr<Window> m_window;
    std::unique_ptr<Parts> m_parts;
};

}  // namespace bullet_fem
