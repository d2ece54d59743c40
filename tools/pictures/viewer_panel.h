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

/// Times of the last frames with steps, for the plot.
struct ViewerTimes
{
    static constexpr int kCount = 180;
    std::array<float, kCount> m_step{};  ///< mean time per step in a frame [ms]
    float m_frame = 0;                   ///< from one frame to the next [ms]
    int m_next = 0;                      ///< index of the next entry

    /// Adds a frame whose `steps` took `stepsMs` in total.
    void add(double stepsMs, int steps, double frameMs);
};

/// Sliders, buttons and plot by Dear ImGui; owns ImGui's context and OpenGL backend. An OpenGL context must be current
/// in all calls.
class ViewerPanel
{
public:
    ViewerPanel();
    ~ViewerPanel();
    ViewerPanel(const ViewerPanel&) = delete;
    ViewerPanel& operator=(const ViewerPanel&) = delete;

    /// Passes an event to ImGui. Returns true if only the panel should handle it.
    bool handle(const ViewerEvent& event);
    /// Shows the panel, in which the user changes parameters and the control.
    void update(ViewerSimulation& simulation, ViewerControl& control, const ViewerTimes& times,
                const PictureSize& size);
    /// Draws the result of `update` into the bound framebuffer.
    void draw() const;

    /// Sets the message on the film.
    void setFilm(const std::string& film) { m_film = film; }
    /// Sets the error of the scene; an empty text hides it.
    void setFault(const std::string& fault) { m_fault = fault; }
    const std::vector<PictureRectangle>& sliders() const { return m_sliders; }

private:
    void showPanel(ViewerSimulation& simulation, ViewerControl& control, const ViewerTimes& times);
    void showSliders(ViewerSimulation& simulation);
    void showDialogs(ViewerSimulation& simulation, ViewerControl& control, const PictureSize& size) const;
    bool isOverPanel(double x, double y) const;

    PictureRectangle m_area;  // of the last update
    std::vector<PictureRectangle> m_sliders;
    std::string m_message;  // error of the last refused setting
    std::string m_fault, m_film;
};

}  // namespace bullet_fem
