// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tools/pictures/overlay.h"
#include "tools/pictures/viewer_control.h"

namespace bullet_fem
{

/// Times of the last frames that had steps, for the plot.
struct ViewerTimes
{
    static constexpr int kCount = 180;
    std::array<float, kCount> m_step{};  ///< a step, the mean of those of a frame [ms]
    float m_frame = 0;                   ///< from one frame to the next [ms]
    int m_next = 0;                      ///< where the next goes

    /// A frame whose `steps` took `stepsMs` together.
    void add(double stepsMs, int steps, double frameMs);
};

/// Sliders, buttons and plot, through Dear ImGui, whose context and OpenGL part it owns. A context of OpenGL must be
/// current in all calls.
class ViewerPanel
{
public:
    ViewerPanel();
    ~ViewerPanel();
    ViewerPanel(const ViewerPanel&) = delete;
    ViewerPanel& operator=(const ViewerPanel&) = delete;

    /// Tells ImGui of an event. True if it is the panel's alone.
    bool handle(const ViewerEvent& event);
    /// Lets the user change the simulation's parameters and the control.
    void update(ViewerSimulation& simulation, ViewerControl& control, const ViewerTimes& times,
                const PictureSize& size);
    /// Draws what `update` made into the bound framebuffer.
    void draw() const;

    /// What is to be said of the film.
    void setFilm(const std::string& film) { m_film = film; }
    /// What is wrong with the scene, shown until it is empty.
    void setFault(const std::string& fault) { m_fault = fault; }
    const std::vector<PictureRectangle>& sliders() const { return m_sliders; }

private:
    void showPanel(ViewerSimulation& simulation, ViewerControl& control, const ViewerTimes& times);
    void showSliders(ViewerSimulation& simulation);
    void showDialogs(ViewerSimulation& simulation, ViewerControl& control, const PictureSize& size) const;
    bool isOverPanel(double x, double y) const;

    PictureRectangle m_area;  // in the last update
    std::vector<PictureRectangle> m_sliders;
    std::string m_message;  // of the last setting that was refused
    std::string m_fault, m_film;
};

}  // namespace bullet_fem
