// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <utility>

/// Owning wrappers of OpenGL objects. A context must be current when they are created, used or destroyed.
namespace bullet_fem
{

/// An OpenGL object name, deleted in the destructor.
class GlObject
{
public:
    using Deleter = void (*)(unsigned);

    GlObject() = default;
    GlObject(unsigned id, Deleter deleter) : m_id(id), m_delete(deleter) {}
    GlObject(GlObject&& other) noexcept { *this = std::move(other); }
    GlObject& operator=(GlObject&& other) noexcept
    {
        std::swap(m_id, other.m_id);
        std::swap(m_delete, other.m_delete);
        return *this;
    }
    ~GlObject()
    {
        if (m_id) m_delete(m_id);
    }

    unsigned id() const { return m_id; }

private:
    unsigned m_id = 0;
    Deleter m_delete = nullptr;
};

GlObject makeGlBuffer();
GlObject makeGlVertexArray();
GlObject makeGlTexture();
GlObject makeGlSampler();
GlObject makeGlFramebuffer();
GlObject makeGlRenderbuffer();

/// Links a program of both shaders, GLSL 3.30 without the #version line. Throws std::runtime_error with the driver's
/// message.
GlObject makeGlProgram(const std::string& vertexShader, const std::string& fragmentShader);

/// Throws std::runtime_error with `where` if OpenGL has reported an error since the last call.
void checkGl(const char* where);

}  // namespace bullet_fem
