// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/gl_objects.h"

#include <epoxy/gl.h>

#include <stdexcept>

namespace bullet_fem
{
namespace
{

GlObject compiled(unsigned kind, const std::string& source)
{
    GlObject shader(glCreateShader(kind), [](unsigned id) { glDeleteShader(id); });
    const std::string whole = "#version 330 core\n" + source;
    const char* text = whole.c_str();
    glShaderSource(shader.id(), 1, &text, nullptr);
    glCompileShader(shader.id());
    int done = 0;
    glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &done);
    if (done) return shader;
    char log[2048] = "";
    glGetShaderInfoLog(shader.id(), sizeof log, nullptr, log);
    throw std::runtime_error(std::string("picture: the OpenGL driver does not compile a shader: ") + log);
}

}  // namespace

GlObject makeGlBuffer()
{
    unsigned id = 0;
    glGenBuffers(1, &id);
    return {id, [](unsigned i) { glDeleteBuffers(1, &i); }};
}

GlObject makeGlVertexArray()
{
    unsigned id = 0;
    glGenVertexArrays(1, &id);
    return {id, [](unsigned i) { glDeleteVertexArrays(1, &i); }};
}

GlObject makeGlTexture()
{
    unsigned id = 0;
    glGenTextures(1, &id);
    return {id, [](unsigned i) { glDeleteTextures(1, &i); }};
}

GlObject makeGlSampler()
{
    unsigned id = 0;
    glGenSamplers(1, &id);
    return {id, [](unsigned i) { glDeleteSamplers(1, &i); }};
}

GlObject makeGlFramebuffer()
{
    unsigned id = 0;
    glGenFramebuffers(1, &id);
    return {id, [](unsigned i) { glDeleteFramebuffers(1, &i); }};
}

GlObject makeGlRenderbuffer()
{
    unsigned id = 0;
    glGenRenderbuffers(1, &id);
    return {id, [](unsigned i) { glDeleteRenderbuffers(1, &i); }};
}

GlObject makeGlProgram(const std::string& vertexShader, const std::string& fragmentShader)
{
    const GlObject vertex = compiled(GL_VERTEX_SHADER, vertexShader),
                   fragment = compiled(GL_FRAGMENT_SHADER, fragmentShader);
    GlObject program(glCreateProgram(), [](unsigned id) { glDeleteProgram(id); });
    glAttachShader(program.id(), vertex.id());
    glAttachShader(program.id(), fragment.id());
    glLinkProgram(program.id());
    int done = 0;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &done);
    if (done) return program;
    char log[2048] = "";
    glGetProgramInfoLog(program.id(), sizeof log, nullptr, log);
    throw std::runtime_error(std::string("picture: the OpenGL driver does not link a shader: ") + log);
}

void checkGl(const char* where)
{
    const unsigned error = glGetError();
    if (error == GL_NO_ERROR) return;
    const char* name = error == GL_OUT_OF_MEMORY ? "out of memory: make the picture or the scene smaller" : "error ";
    throw std::runtime_error(std::string("picture: OpenGL reports in ") + where + ": " + name +
                             (error == GL_OUT_OF_MEMORY ? "" : std::to_string(error)));
}

}  // namespace bullet_fem
