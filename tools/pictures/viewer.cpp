// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/viewer.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "tools/pictures/film_recorder.h"
#include "tools/pictures/picture_framebuffer.h"
#include "tools/pictures/scene_renderer.h"
#include "tools/pictures/viewer_panel.h"

namespace bullet_fem
{
namespace
{

[[noreturn]] void noWindow()
{
    const char* words = nullptr;
    glfwGetError(&words);
    throw std::runtime_error(
        std::string("viewer: no window can be opened: ") + (words ? words : "unknown reason") +
        "; it needs a display with OpenGL 3.3. Without one, xvfb-run gives a virtual one, and pictures "
        "can be drawn off-screen");
}

/// Initialises GLFW, and terminates it in the destructor.
struct Glfw
{
    Glfw()
    {
        if (!glfwInit()) noWindow();
    }
    ~Glfw() { glfwTerminate(); }
    Glfw(const Glfw&) = delete;
    Glfw& operator=(const Glfw&) = delete;
};

/// Makes a window's context current during its lifetime, and no context afterwards, so that off-screen renderers work
/// between frames.
struct Current
{
    explicit Current(GLFWwindow* window) { glfwMakeContextCurrent(window); }
    ~Current() { glfwMakeContextCurrent(nullptr); }
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;
};

double milliseconds(double seconds)
{
    return 1e3 * seconds;
}

}  // namespace

/// The window and the user's input since the last frame.
struct Viewer::Window
{
    Glfw m_library;
    GLFWwindow* m_window = nullptr;
    std::vector<ViewerEvent> m_events;

    explicit Window(const ViewerSettings& settings)
    {
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        m_window = glfwCreateWindow(settings.m_size.m_width, settings.m_size.m_height, settings.m_title.c_str(),
                                    nullptr, nullptr);
        if (!m_window) noWindow();
        glfwSetWindowUserPointer(m_window, this);
        glfwSetCursorPosCallback(m_window, onMove);
        glfwSetMouseButtonCallback(m_window, onButton);
        glfwSetScrollCallback(m_window, onScroll);
        glfwSetKeyCallback(m_window, onKey);
        glfwSetDropCallback(m_window, onDrop);
        const Current current(m_window);
        glfwSwapInterval(1);
    }
    ~Window() { glfwDestroyWindow(m_window); }
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    PictureSize pixels() const
    {
        PictureSize size;
        glfwGetFramebufferSize(m_window, &size.m_width, &size.m_height);
        return size;
    }

    static std::vector<ViewerEvent>& events(GLFWwindow* window)
    {
        return static_cast<Window*>(glfwGetWindowUserPointer(window))->m_events;
    }
    static void onMove(GLFWwindow* window, double x, double y)
    {
        int width = 1, height = 1, columns = 1, rows = 1;  // of the window, whose units may differ from pixels
        glfwGetWindowSize(window, &width, &height);
        glfwGetFramebufferSize(window, &columns, &rows);
        events(window).push_back(ViewerEvent::move(x * columns / std::max(width, 1), y * rows / std::max(height, 1)));
    }
    static void onButton(GLFWwindow* window, int button, int action, int)
    {
        if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
        const MouseButton b = button == GLFW_MOUSE_BUTTON_LEFT    ? MouseButton::left
                              : button == GLFW_MOUSE_BUTTON_RIGHT ? MouseButton::right
                                                                  : MouseButton::middle;
        events(window).push_back(action == GLFW_PRESS ? ViewerEvent::press(b) : ViewerEvent::release(b));
    }
    static void onScroll(GLFWwindow* window, double, double clicks)
    {
        events(window).push_back(ViewerEvent::scroll(clicks));
    }
    static void onDrop(GLFWwindow* window, int count, const char** paths)
    {
        double x = 0, y = 0;
        glfwGetCursorPos(window, &x, &y);
        onMove(window, x, y);
        events(window).push_back(ViewerEvent::drop({paths, paths + count}));
    }
    /// Whether the key repeats while it is held down.
    static bool repeats(ViewerKey key)
    {
        return key == ViewerKey::step || key == ViewerKey::earlier || key == ViewerKey::later;
    }
    static void onKey(GLFWwindow* window, int key, int, int action, int)
    {
        constexpr std::pair<int, ViewerKey> keys[] = {
            {GLFW_KEY_SPACE, ViewerKey::pause},  {GLFW_KEY_RIGHT, ViewerKey::step},
            {GLFW_KEY_LEFT, ViewerKey::earlier}, {GLFW_KEY_COMMA, ViewerKey::earlier},
            {GLFW_KEY_PERIOD, ViewerKey::later}, {GLFW_KEY_B, ViewerKey::box},
            {GLFW_KEY_O, ViewerKey::ball},       {GLFW_KEY_C, ViewerKey::forces},
            {GLFW_KEY_S, ViewerKey::stress},     {GLFW_KEY_F, ViewerKey::film},
            {GLFW_KEY_X, ViewerKey::cancel},     {GLFW_KEY_W, ViewerKey::wireframe},
            {GLFW_KEY_R, ViewerKey::resetView},  {GLFW_KEY_H, ViewerKey::panel},
            {GLFW_KEY_F1, ViewerKey::help},      {GLFW_KEY_ESCAPE, ViewerKey::close}};
        for (const auto& [code, meaning] : keys)
            if (key == code && (action == GLFW_PRESS || (action == GLFW_REPEAT && repeats(meaning))))
                events(window).push_back(ViewerEvent::key(meaning));
    }
};

struct Viewer::Parts
{
    ViewerSimulation& m_simulation;
    ViewerControl m_control;
    SceneRenderer m_renderer;
    ViewerPanel m_panel;
    std::unique_ptr<PictureFramebuffer> m_framebuffer;
    FilmRecorder m_film;
    ViewerTimes m_times;
    double m_lastFrame = 0;  // [s]
    int m_largestCatchUp;

    Parts(ViewerSimulation& simulation, const ViewerSettings& settings)
        : m_simulation(simulation),
          m_control(simulation),
          m_film(settings.m_filmFolder),
          m_largestCatchUp(settings.m_largestCatchUp)
    {
        m_control.setPaused(settings.m_paused);
    }

    void step(int due)
    {
        const double start = glfwGetTime();
        const int steps = m_control.takeSteps(due);
        for (int k = 0; k < steps; ++k) m_simulation.step();
        m_film.advance(steps * m_simulation.timeStep());
        const double end = glfwGetTime();
        m_times.add(milliseconds(end - start), steps, milliseconds(end - m_lastFrame));
        m_lastFrame = end;
    }

    /// Starts and ends films at the control's request, and appends the picture without the panel.
    void film(const PictureSize& size)
    {
        m_film.update();
        if (m_control.filming() && !m_film.recording()) m_film.start(size);
        if (!m_control.filming() && m_film.recording()) m_film.stop();
        if (m_film.due() > 0) m_film.append(m_framebuffer->read());
        m_control.setFilming(m_film.recording());
    }

    void draw(const PictureSize& size)
    {
        if (!m_framebuffer || m_framebuffer->size().m_width != size.m_width ||
            m_framebuffer->size().m_height != size.m_height)
        {
            m_framebuffer.reset();
            m_framebuffer = std::make_unique<PictureFramebuffer>(size);
        }
        m_framebuffer->bind();
        m_renderer.setWireframe(m_control.wireframe());
        try
        {
            m_renderer.draw(m_simulation.scene(), m_control.camera(), size);
            m_panel.setFault({});
        }
        catch (const std::invalid_argument& fault)  // keeps the previous picture
        {
            m_panel.setFault(fault.what());
            m_control.setPaused(true);
        }
        m_framebuffer->resolve();
        film(size);
        m_panel.draw();
        m_framebuffer->copyTo(0);
    }
};

Viewer::Viewer(ViewerSimulation& simulation, const ViewerSettings& settings)
    : m_window(std::make_unique<Window>(settings))
{
    const Current current(m_window->m_window);
    m_parts = std::make_unique<Parts>(simulation, settings);
}

Viewer::~Viewer()
{
    const Current current(m_window->m_window);
    m_parts.reset();
}

bool Viewer::frame(int steps, double drawnTime)
{
    const Current current(m_window->m_window);
    glfwPollEvents();
    Parts& parts = *m_parts;
    const PictureSize size = m_window->pixels();
    if (size.m_width > 0 && size.m_height > 0)  // else the window is minimised
    {
        for (const ViewerEvent& event : m_window->m_events)
            if (!parts.m_panel.handle(event)) parts.m_control.handle(event, size);
        m_window->m_events.clear();
        parts.m_simulation.update();
        parts.m_control.update();
        parts.m_panel.setFilm(parts.m_film.message());
        parts.m_panel.update(parts.m_simulation, parts.m_control, parts.m_times, size);
    }
    parts.step(steps);
    parts.m_simulation.setDrawnTime(parts.m_control.paused() ? 0 : drawnTime);
    if (size.m_width > 0 && size.m_height > 0) parts.draw(size);
    glfwSwapBuffers(m_window->m_window);
    return !parts.m_control.closing() && !glfwWindowShouldClose(m_window->m_window);
}

// Drawing lags by one step: it interpolates between the last two states, as Bullet's motion states do.
void Viewer::run()
{
    double before = glfwGetTime(), due = 0;
    for (int steps = 1; frame(steps, due - 1);)
    {
        const double now = glfwGetTime(), length = m_parts->m_simulation.timeStep();
        due = std::min(due + (now - before) / length, static_cast<double>(m_parts->m_largestCatchUp));
        before = now;
        steps = static_cast<int>(due);
        due -= steps;
    }
}

void Viewer::inject(const ViewerEvent& event)
{
    m_window->m_events.push_back(event);
}

PictureRectangle Viewer::sliderArea(std::size_t index) const
{
    const std::vector<PictureRectangle>& sliders = m_parts->m_panel.sliders();
    return index < sliders.size() ? sliders[index] : PictureRectangle{};
}

Image Viewer::screenshot() const
{
    const Current current(m_window->m_window);
    return m_parts->m_framebuffer ? m_parts->m_framebuffer->read() : Image();
}

const ViewerControl& Viewer::control() const
{
    return m_parts->m_control;
}

PictureSize Viewer::size() const
{
    return m_window->pixels();
}

}  // namespace bullet_fem
