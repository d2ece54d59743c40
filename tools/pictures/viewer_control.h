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

/// Something that the user did.
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
    PicturePoint m_mouse;                      ///< of a move
    MouseButton m_button = MouseButton::left;  ///< of a press or release, where the mouse is
    double m_scroll = 0;                       ///< clicks of the wheel, > 0 away from the user
    ViewerKey m_key = ViewerKey::pause;
    std::vector<std::string> m_files;  ///< that were dropped where the mouse is

    static ViewerEvent move(double x, double y);
    static ViewerEvent press(MouseButton button = MouseButton::left);
    static ViewerEvent release(MouseButton button = MouseButton::left);
    static ViewerEvent scroll(double clicks);
    static ViewerEvent key(ViewerKey key);
    static ViewerEvent drop(const std::vector<std::string>& files);
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
    /// Takes the camera of the scene as it is now.
    void resetView();
    /// The same, if there is another thing to be seen. To be called in every frame.
    void update();
    bool panelShown() const { return m_panelShown; }
    bool helpShown() const { return m_helpShown; }
    void setHelpShown(bool shown) { m_helpShown = shown; }
    /// A film is wanted of what is seen.
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
    MouseButton m_button = MouseButton::left;  // that m_mode began with
    bool m_paused = false, m_wireframe = false, m_panelShown = true, m_closing = false;
    bool m_helpShown = false, m_filming = false;
    int m_requestedSteps = 0;
    int m_view;  // of the simulation, that the camera was taken at
};

}  // namespace bullet_fem
