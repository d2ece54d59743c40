// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/viewer_control.h"

#include <cmath>
#include <utility>

namespace bullet_fem
{
namespace
{

constexpr double kOrbitAngle = 5;  // rotation [rad] for a mouse movement of the picture's height
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

ViewerEvent ViewerEvent::drop(const std::vector<std::string>& files)
{
    ViewerEvent event;
    event.m_kind = Kind::drop;
    event.m_files = files;
    return event;
}

ViewerControl::ViewerControl(ViewerSimulation& simulation)
    : m_simulation(simulation), m_orbit(simulation.scene().m_camera), m_view(simulation.views())
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
            return key(event.m_key, size);
        case ViewerEvent::Kind::drop:
            return m_simulation.open(event.m_files, ray(size));
    }
}

/// The ray through the mouse position, long enough to cross the scene.
PictureRay ViewerControl::ray(const PictureSize& size)
{
    const PictureBounds box = bounds(m_simulation.scene());
    return rayThrough(camera(), size, m_mouse, norm(camera().m_eye - box.centre()) + 2 * box.radius());
}

void ViewerControl::press(MouseButton button, const PictureSize& size)
{
    if (m_mode != Mode::none) return;  // one action at a time
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
    const double height = 2 * std::tan(0.5 * camera().m_fieldOfView);  // of the view at distance 1
    if (m_mode == Mode::pan) m_orbit.pan(-height * right, height * down);
}

void ViewerControl::key(ViewerKey key, const PictureSize& size)
{
    switch (key)
    {
        case ViewerKey::pause:
            m_paused = !m_paused;
            return;
        case ViewerKey::step:
            return requestStep();
        case ViewerKey::wireframe:
            m_wireframe = !m_wireframe;
            return;
        case ViewerKey::resetView:
            return resetView();
        case ViewerKey::panel:
            m_panelShown = !m_panelShown;
            return;
        case ViewerKey::help:
            m_helpShown = !m_helpShown;
            return;
        case ViewerKey::film:
            m_filming = !m_filming;
            return;
        case ViewerKey::close:
            m_closing = true;
            return;
        case ViewerKey::earlier:
        case ViewerKey::later:
            m_paused = true;
            release(m_button);  // releases the held body
            break;
        default:
            break;
    }
    m_simulation.act(key, ray(size));
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
    m_orbit = OrbitCamera(m_simulation.scene().m_camera);
    m_view = m_simulation.views();
}

void ViewerControl::update()
{
    if (m_simulation.views() != m_view) resetView();
}

}  // namespace bullet_fem
