// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "tools/pictures/viewer_simulation.h"

namespace bullet_fem
{

enum class MouseButton
{
    left,
    right,
    middle
};

/// A user event.
struct ViewerEvent
{
    enum class Kind
    {
        move,
        press,
        release,
        scroll,
        key,
        drop
    };
    Kind m_kind = Kind::move;
    PicturePoint m_mouse;                      ///< position of a move
    MouseButton m_button = MouseButton::left;  ///< of a press or release at the mouse position
    double m_scroll = 0;                       ///< clicks of the wheel, > 0 away from the user
    ViewerKey m_key = ViewerKey::pause;
    std::vector<std::string> m_files;  ///< dropped at the mouse position

    static ViewerEvent move(double x, double y);
    static ViewerEvent press(MouseButton button = MouseButton::left);
    static ViewerEvent release(MouseButton button = MouseButton::left);
    static ViewerEvent scroll(double clicks);
    static ViewerEvent key(ViewerKey key);
    static ViewerEvent drop(const std::vector<std::string>& files);
};

/// Interprets events: the left button drags a body under it and orbits elsewhere, the right and middle buttons pan, the
/// wheel zooms. Needs no window.
class ViewerControl
{
public:
    /// The simulation must outlive this.
    explicit ViewerControl(ViewerSimulation& simulation);

    /// `size` is that of the picture, in whose pixels mouse positions are given.
    void handle(const ViewerEvent& event, const PictureSize& size);

    const PictureCamera& camera() const { return m_orbit.camera(); }
    bool paused() const { return m_paused; }
    void setPaused(bool paused) { m_paused = paused; }
    /// Pauses, and makes the next takeSteps return one step.
    void requestStep();
    /// Number of steps to make; `due` is their number without a pause.
    int takeSteps(int due);
    bool wireframe() const { return m_wireframe; }
    void setWireframe(bool wireframe) { m_wireframe = wireframe; }
    /// Resets the camera to that of the present scene.
    void resetView();
    /// Resets the camera if ViewerSimulation::views has changed. Call in each frame.
    void update();
    bool panelShown() const { return m_panelShown; }
    bool helpShown() const { return m_helpShown; }
    void setHelpShown(bool shown) { m_helpShown = shown; }
    /// Whether the user has requested a film.
    bool filming() const { return m_filming; }
    void setFilming(bool filming) { m_filming = filming; }
    bool closing() const { return m_closing; }
    bool dragging() const { return m_mode == Mode::drag; }

private:
    enum class Mode
    {
        none,
        drag,
        orbit,
        pan
    };
    PictureRay ray(const PictureSize& size);
    void press(MouseButton button, const PictureSize& size);
    void release(MouseButton button);
    void move(const PicturePoint& to, const PictureSize& size);
    void key(ViewerKey key, const PictureSize& size);

    ViewerSimulation& m_simulation;
    OrbitCamera m_orbit;
    PicturePoint m_mouse;
    Mode m_mode = Mode::none;
    MouseButton m_button = MouseButton::left;  // button that started m_mode
    bool m_paused = false, m_wireframe = false, m_panelShown = true, m_closing = false;
    bool m_helpShown = false, m_filming = false;
    int m_requestedSteps = 0;
    int m_view;  // value of ViewerSimulation::views for the present camera
};

}  // namespace bullet_fem
