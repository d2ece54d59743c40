// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/pictures/viewer_simulation.h"

namespace bullet_fem
{

enum class MouseButton
{
    left,
    right,
    middle
};

/// The keys that the viewer knows.
enum class ViewerKey
{
    pause,      ///< space
    step,       ///< right arrow: one step, and pause
    wireframe,  ///< W
    resetView,  ///< R
    panel,      ///< H: hides or shows the panel
    close       ///< escape
};

/// Something that the user did.
struct ViewerEvent
{
    enum class Kind
    {
        move,
        press,
        release,
        scroll,
        key
    };
    Kind m_kind = Kind::move;
    PicturePoint m_mouse;                      ///< of a move
    MouseButton m_button = MouseButton::left;  ///< of a press or release, where the mouse is
    double m_scroll = 0;                       ///< clicks of the wheel, > 0 away from the user
    ViewerKey m_key = ViewerKey::pause;

    static ViewerEvent move(double x, double y);
    static ViewerEvent press(MouseButton button = MouseButton::left);
    static ViewerEvent release(MouseButton button = MouseButton::left);
    static ViewerEvent scroll(double clicks);
    static ViewerEvent key(ViewerKey key);
};

/// What events mean: the left button drags what it hits and orbits elsewhere, the right and the middle one pan, the
/// wheel zooms. Needs no window.
class ViewerControl
{
public:
    /// The simulation must outlive this.
    explicit ViewerControl(ViewerSimulation& simulation);

    /// `size` is the picture's, whose pixels the mouse moves over.
    void handle(const ViewerEvent& event, const PictureSize& size);

    const PictureCamera& camera() const { return m_orbit.camera(); }
    bool paused() const { return m_paused; }
    void setPaused(bool paused) { m_paused = paused; }
    /// Pauses, and makes the next takeSteps give one step more.
    void requestStep();
    /// How many steps to make where `due` would be made without a pause.
    int takeSteps(int due);
    bool wireframe() const { return m_wireframe; }
    void setWireframe(bool wireframe) { m_wireframe = wireframe; }
    void resetView();
    bool panelShown() const { return m_panelShown; }
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
    void key(ViewerKey key);

    ViewerSimulation& m_simulation;
    PictureCamera m_start;
    OrbitCamera m_orbit;
    PicturePoint m_mouse;
    Mode m_mode = Mode::none;
    MouseButton m_button = MouseButton::left;  // that m_mode began with
    bool m_paused = false, m_wireframe = false, m_panelShown = true, m_closing = false;
    int m_requestedSteps = 0;
};

}  // namespace bullet_fem
