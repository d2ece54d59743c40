// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/viewer_control.h"

#include <cmath>
#include <utility>

namespace bullet_fem
{
namespace
{

constexpr double kOrbitAngle = 5;  // [rad] over the picture's height
constexpr double kZoomPerClick = 0.9;

}  // namespace

ViewerEvent ViewerEvent::move(double x, double y)
{
    ViewerEvent event;
    event.m_mouse = {x, y};
    return event;
}

ViewerEvent ViewerEvent::press(MouseButton button)
{
    ViewerEvent event;
    event.m_kind = Kind::press;
    event.m_button = button;
    return event;
}

ViewerEvent ViewerEvent::release(MouseButton button)
{
    ViewerEvent event;
    event.m_kind = Kind::release;
    event.m_button = button;
    return event;
}

ViewerEvent ViewerEvent::scroll(double clicks)
{
    ViewerEvent event;
    event.m_kind = Kind::scroll;
    event.m_scroll = clicks;
    return event;
}

ViewerEvent ViewerEvent::key(ViewerKey key)
{
    ViewerEvent event;
    event.m_kind = Kind::key;
    event.m_key = key;
    return event;
}

ViewerControl::ViewerControl(ViewerSimulation& simulation)
    : m_simulation(simulation), m_start(simulation.scene().m_camera), m_orbit(m_start)
{
}

void ViewerControl::handle(const ViewerEvent& event, const PictureSize& size)
{
    switch (event.m_kind)
    {
        case ViewerEvent::Kind::move:
            return move(event.m_mouse, size);
        case ViewerEvent::Kind::press:
            return press(event.m_button, size);
        case ViewerEvent::Kind::release:
            return release(event.m_button);
        case ViewerEvent::Kind::scroll:
            return m_orbit.zoom(std::pow(kZoomPerClick, event.m_scroll));
        case ViewerEvent::Kind::key:
            return key(event.m_key);
    }
}

/// Under the mouse, through the whole scene.
PictureRay ViewerControl::ray(const PictureSize& size)
{
    const PictureBounds box = bounds(m_simulation.scene());
    return rayThrough(camera(), size, m_mouse, norm(camera().m_eye - box.centre()) + 2 * box.radius());
}

void ViewerControl::press(MouseButton button, const PictureSize& size)
{
    if (m_mode != Mode::none) return;  // one thing at a time
    m_button = button;
    if (button != MouseButton::left)
        m_mode = Mode::pan;
    else
        m_mode = m_simulation.beginDrag(ray(size)) ? Mode::drag : Mode::orbit;
}

void ViewerControl::release(MouseButton button)
{
    if (button != m_button) return;
    if (std::exchange(m_mode, Mode::none) == Mode::drag) m_simulation.endDrag();
}

void ViewerControl::move(const PicturePoint& to, const PictureSize& size)
{
    const double right = (to.m_x - m_mouse.m_x) / size.m_height, down = (to.m_y - m_mouse.m_y) / size.m_height;
    m_mouse = to;
    if (m_mode == Mode::drag) m_simulation.moveDrag(ray(size));
    if (m_mode == Mode::orbit) m_orbit.orbit(-kOrbitAngle * right, kOrbitAngle * down);
    const double height = 2 * std::tan(0.5 * camera().m_fieldOfView);  // of the picture at distance 1
    if (m_mode == Mode::pan) m_orbit.pan(-height * right, height * down);
}

void ViewerControl::key(ViewerKey key)
{
    if (key == ViewerKey::pause) m_paused = !m_paused;
    if (key == ViewerKey::step) requestStep();
    if (key == ViewerKey::wireframe) m_wireframe = !m_wireframe;
    if (key == ViewerKey::resetView) resetView();
    if (key == ViewerKey::panel) m_panelShown = !m_panelShown;
    if (key == ViewerKey::close) m_closing = true;
}

void ViewerControl::requestStep()
{
    m_paused = true;
    ++m_requestedSteps;
}

int ViewerControl::takeSteps(int due)
{
    const int requested = std::exchange(m_requestedSteps, 0);
    return m_paused ? requested : due;
}

void ViewerControl::resetView()
{
    m_orbit = OrbitCamera(m_start);
}

}  // namespace bullet_fem
