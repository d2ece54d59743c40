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

/// Initial settings of a window.
struct ViewerSettings
{
    std::string m_title = "BulletFEM";
    PictureSize m_size;  ///< of the window; the user can change it
    bool m_paused = false;
    int m_largestCatchUp = 4;        ///< maximum steps per frame if the simulation is slower than real time
    std::string m_filmFolder = ".";  ///< folder of films made by the user
};

/// A window that shows a simulation under user control. At most one per program, used from the main thread.
class Viewer
{
public:
    /// Opens the window. The simulation must outlive it. Throws std::runtime_error with the reason if no window can be
    /// opened.
    explicit Viewer(ViewerSimulation& simulation, const ViewerSettings& settings = {});
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    /// Steps in real time and draws until the user closes the window.
    void run();
    /// Handles user input, makes `steps` steps unless paused, and draws. A scene that is not `valid` pauses the viewer,
    /// which shows the reason. `drawnTime` is passed to ViewerSimulation::setDrawnTime, 0 while paused. Returns false
    /// if the window is to be closed.
    bool frame(int steps = 1, double drawnTime = 0);

    /// Injects an event as user input for the next frame. Sliders and buttons process one event per frame.
    void inject(const ViewerEvent& event);
    /// Position of the slider of parameter `index` in the last frame [pixels]; empty if it was not shown.
    PictureRectangle sliderArea(std::size_t index) const;
    /// The last frame, including the panel.
    Image screenshot() const;

    const ViewerControl& control() const;
    /// Size of the picture [pixels].
    PictureSize size() const;

private:
    struct Window;
    struct Parts;
    std::unique_ptr<Window> m_window;
    std::unique_ptr<Parts> m_parts;
};

}  // namespace bullet_fem
