// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/offscreen_renderer.h"

#include <epoxy/gl.h>
// EGL is linked, because epoxy would terminate the program if it is missing.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <cstring>
#include <stdexcept>

#include "tools/pictures/picture_framebuffer.h"
#include "tools/pictures/scene_renderer.h"

namespace bullet_fem
{
namespace
{

[[noreturn]] void noEgl(const std::string& what)
{
    throw std::runtime_error("picture: " + what +
                             "; install an OpenGL driver for EGL (Debian: libegl-mesa0 and libgl1-mesa-dri)");
}

bool hasExtension(EGLDisplay display, const char* name)
{
    const char* all = eglQueryString(display, EGL_EXTENSIONS);
    return all && std::strstr(all, name);
}

/// A display that needs neither X nor Wayland; else the default one. It is never terminated, because all users of EGL
/// in a program share it.
EGLDisplay initializedDisplay()
{
    const auto initialized = [](EGLDisplay display)
    { return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr); };
    if (hasExtension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    {
        const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (initialized(display)) return display;
    }
    const EGLDisplay display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (!initialized(display)) noEgl("there is no EGL display to draw on without a screen");
    return display;
}

}  // namespace

struct OffscreenRenderer::Context
{
    EGLDisplay m_display = initializedDisplay();
    EGLContext m_context = EGL_NO_CONTEXT;

    Context()
    {
        if (!hasExtension(m_display, "EGL_KHR_surfaceless_context") ||
            !hasExtension(m_display, "EGL_KHR_no_config_context"))
            noEgl("this EGL cannot draw without a window");
        if (!eglBindAPI(EGL_OPENGL_API)) noEgl("this EGL has no OpenGL");
        const EGLint wanted[] = {
            EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        m_context = eglCreateContext(m_display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
        if (m_context == EGL_NO_CONTEXT) noEgl("this EGL has no OpenGL 3.3");
    }
    ~Context() { eglDestroyContext(m_display, m_context); }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
};

struct OffscreenRenderer::Parts
{
    SceneRenderer m_renderer;
    std::unique_ptr<PictureFramebuffer> m_framebuffer;
    std::string m_driver;
};

namespace
{

/// Keeps a context current during its lifetime.
class Current
{
public:
    Current(EGLDisplay display, EGLContext context) : m_display(display)
    {
        if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
            throw std::runtime_error(
                "picture: EGL's context cannot be used; is another OpenGL context current in this thread?");
    }
    ~Current() { eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

private:
    EGLDisplay m_display;
};

}  // namespace

OffscreenRenderer::OffscreenRenderer() : m_context(std::make_unique<Context>())
{
    const Current current(m_context->m_display, m_context->m_context);
    m_parts = std::make_unique<Parts>();
    m_parts->m_driver = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

OffscreenRenderer::~OffscreenRenderer()
{
    // Deleting the context deletes its objects; if it cannot be made current, they must not be deleted in another
    // context.
    if (eglMakeCurrent(m_context->m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, m_context->m_context))
    {
        m_parts.reset();
        eglMakeCurrent(m_context->m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    else
        static_cast<void>(m_parts.release());
}

Image OffscreenRenderer::render(const PictureScene& scene, const PictureSize& size)
{
    const Current current(m_context->m_display, m_context->m_context);
    std::unique_ptr<PictureFramebuffer>& framebuffer = m_parts->m_framebuffer;
    if (!framebuffer || framebuffer->size().m_width != size.m_width || framebuffer->size().m_height != size.m_height)
    {
        framebuffer.reset();
        framebuffer = std::make_unique<PictureFramebuffer>(size);
    }
    framebuffer->bind();
    m_parts->m_renderer.draw(scene, scene.m_camera, size);
    framebuffer->resolve();
    return framebuffer->read();
}

std::string OffscreenRenderer::driver() const
{
    return m_parts->m_driver;
}

}  // namespace bullet_fem
