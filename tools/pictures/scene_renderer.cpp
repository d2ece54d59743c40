// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/scene_renderer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "bullet_fem/io/colour_map.h"
#include "tools/pictures/legend.h"
#include "tools/pictures/light_map.h"
#include "tools/pictures/shaders.h"

namespace bullet_fem
{
namespace
{

constexpr int kKeyMapSide = 2048, kSkyMapSide = 192;  // [texels]
constexpr double kSkyReach = 0.3;                     // extent of the sky's map beyond the scene [radii]
constexpr double kGroundExtent = 14;                  // half side of the ground's square: minimum [radii],
constexpr double kGroundReach = 6;                    // and relative to the distance of the eye from the scene
constexpr double kFar = 60;                           // far clipping distance beyond the ground [radii]
constexpr double kHiddenArrows = 0.45;                // opacity of arrows behind surfaces
constexpr double kNear = 0.004;                       // near clipping distance over the distance to the scene
constexpr int kMapUnit = 0, kKeyUnit = 1, kKeyShadowUnit = 2, kSkyUnit = 3;  // texture units

/// Triangles with common drawing attributes.
struct Range
{
    int m_first = 0, m_count = 0;
    Colour m_colour;
    bool m_coloured = false, m_lit = true, m_wires = false, m_arrows = false;
};

/// Sets uniforms of a program by name; names removed by the compiler are ignored.
struct Uniforms
{
    unsigned m_program;

    int at(const char* name) const { return glGetUniformLocation(m_program, name); }
    void set(const char* name, bool b) const { glUniform1i(at(name), b); }
    void set(const char* name, int i) const { glUniform1i(at(name), i); }
    void set(const char* name, float x) const { glUniform1f(at(name), x); }
    void set(const char* name, double x) const { set(name, static_cast<float>(x)); }
    void set(const char* name, double x, double y) const
    {
        glUniform2f(at(name), static_cast<float>(x), static_cast<float>(y));
    }
    void set(const char* name, const Vec3& v) const
    {
        glUniform3f(at(name), static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
    }
    void set(const char* name, const Colour& c) const { set(name, Vec3{c.r, c.g, c.b}); }
    void set(const char* name, const Matrix4& m) const { glUniformMatrix4fv(at(name), 1, GL_FALSE, m.data()); }
};

double groundExtent(const PictureCamera& camera)
{
    return std::max(kGroundExtent, kGroundReach * norm(camera.m_eye));
}

/// Transformation from PictureUnits to OpenGL's clip space.
Matrix4 clipFromScene(const PictureCamera& camera, const PictureSize& size)
{
    const CameraAxes a = axes(camera);
    const double s = std::tan(0.5 * camera.m_fieldOfView), wide = static_cast<double>(size.m_width) / size.m_height;
    const double distance = norm(camera.m_eye), nearest = kNear * std::max(distance, 0.1);
    const double farthest = distance + 1.5 * groundExtent(camera) + kFar;
    const double c = (farthest + nearest) / (farthest - nearest), d = -2 * farthest * nearest / (farthest - nearest);
    Matrix4Rows rows;
    const Vec3 row[] = {a.m_right * (1 / (s * wide)), a.m_up * (1 / s), -c * a.m_back, -a.m_back};
    for (int i = 0; i < 4; ++i)
    {
        rows.m_row[i] = row[i];
        rows.m_constant[i] = -dot(row[i], camera.m_eye);
    }
    rows.m_constant[2] += d;
    return matrix4(rows);
}

unsigned textureOfColourMap(unsigned texture)
{
    std::vector<unsigned char> pixels;
    for (int i = 0; i < 256; ++i)
    {
        const Vec3 c = viridis(i / 255.);
        for (const double part : {c.x, c.y, c.z}) pixels.push_back(static_cast<unsigned char>(std::lround(255 * part)));
    }
    glBindTexture(GL_TEXTURE_2D, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, 256, 1, 0, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    for (const unsigned wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    for (const unsigned filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    return texture;
}

}  // namespace

struct SceneRenderer::Parts
{
    GlObject m_surface, m_depth, m_groundProgram, m_backgroundProgram;
    GlObject m_buffer, m_vertexArray, m_noVertices, m_colourMap, m_shadowSampler;
    LightMap m_key{kKeyMapSide}, m_sky{kSkyMapSide};
    Overlay m_overlay;

    bool m_allWires = false;

    // State of the present picture:
    PictureUnits m_units;
    PictureCamera m_camera;  // in m_units
    PictureSize m_size;
    GroundPlane m_ground;
    Vec3 m_towardsKey, m_upwards;
    Matrix4 m_clip{};
    std::vector<PictureVertex> m_vertices;  // a member, to reuse its memory
    std::vector<Range> m_ranges;

    Parts();
    void collect(const PictureScene& scene);
    void place(const PictureScene& scene, const PictureCamera& camera);
    void drawLightMaps(const PictureScene& scene);
    void setLight(const PictureScene& scene, const Uniforms& uniforms) const;
    void drawBackground(const PictureScene& scene) const;
    void drawGround(const PictureScene& scene) const;
    void drawSurfaces(const PictureScene& scene) const;
};

SceneRenderer::Parts::Parts()
    : m_surface(makeGlProgram(surfaceVertexShader(), surfaceFragmentShader())),
      m_depth(makeGlProgram(depthVertexShader(), depthFragmentShader())),
      m_groundProgram(makeGlProgram(groundVertexShader(), groundFragmentShader())),
      m_backgroundProgram(makeGlProgram(backgroundVertexShader(), backgroundFragmentShader())),
      m_buffer(makeGlBuffer()),
      m_vertexArray(makeGlVertexArray()),
      m_noVertices(makeGlVertexArray()),
      m_colourMap(makeGlTexture()),
      m_shadowSampler(makeGlSampler())
{
    textureOfColourMap(m_colourMap.id());
    const unsigned sampler = m_shadowSampler.id();
    glSamplerParameteri(sampler, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glSamplerParameteri(sampler, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    for (const unsigned filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glSamplerParameteri(sampler, filter, GL_LINEAR);
    for (const unsigned wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glSamplerParameteri(sampler, wrap, GL_CLAMP_TO_BORDER);
    const float farthest[] = {1, 1, 1, 1};
    glSamplerParameterfv(sampler, GL_TEXTURE_BORDER_COLOR, farthest);

    glBindVertexArray(m_vertexArray.id());
    glBindBuffer(GL_ARRAY_BUFFER, m_buffer.id());
    const auto attribute = [](unsigned index, int parts, std::size_t offset)
    {
        glEnableVertexAttribArray(index);
        glVertexAttribPointer(index, parts, GL_FLOAT, GL_FALSE, sizeof(PictureVertex),
                              reinterpret_cast<const void*>(offset));
    };
    attribute(0, 3, offsetof(PictureVertex, m_position));
    attribute(1, 3, offsetof(PictureVertex, m_normal));
    attribute(2, 1, offsetof(PictureVertex, m_share));
}

/// Sets the units, and converts camera, ground and light to them.
void SceneRenderer::Parts::place(const PictureScene& scene, const PictureCamera& camera)
{
    const PictureBounds box = scene.m_bounds ? *scene.m_bounds : bounds(scene);
    m_units.m_origin = box.centre();
    m_units.m_length = box.radius() > 0 ? box.radius() : 1;
    m_camera = camera;
    m_camera.m_eye = m_units.place(camera.m_eye);
    m_camera.m_target = m_units.place(camera.m_target);
    m_ground.m_shown = scene.m_ground.m_shown;
    m_ground.m_point = m_units.place(scene.m_ground.m_point);
    m_ground.m_normal = m_upwards = unit(scene.m_ground.m_normal);
    m_towardsKey = unit(scene.m_light.m_towards);
    m_clip = clipFromScene(m_camera, m_size);
}

/// Collects meshes, then arrows, which cast no shadows.
void SceneRenderer::Parts::collect(const PictureScene& scene)
{
    m_vertices.clear();
    m_ranges.clear();
    const auto close = [&](Range range)
    {
        range.m_first = m_ranges.empty() ? 0 : m_ranges.back().m_first + m_ranges.back().m_count;
        range.m_count = static_cast<int>(m_vertices.size()) - range.m_first;
        m_ranges.push_back(range);
    };
    for (const PictureMesh& mesh : scene.m_meshes)
    {
        appendVertices(mesh, m_units, scene.m_colourScale, m_vertices);
        close({0, 0, mesh.m_colour, !mesh.m_scalars.empty(), mesh.m_lit, mesh.m_wireframe || m_allWires});
    }
    const std::size_t casters = m_vertices.size();
    for (const PictureArrows& arrows : scene.m_arrows)
    {
        appendVertices(arrows, m_units, m_vertices);
        close({0, 0, arrows.m_colour, false, true, false, true});
    }
    glBindBuffer(GL_ARRAY_BUFFER, m_buffer.id());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(m_vertices.size() * sizeof(PictureVertex)), m_vertices.data(),
                 GL_STREAM_DRAW);
    m_vertices.resize(casters);
}

void SceneRenderer::Parts::drawLightMaps(const PictureScene& scene)
{
    if (!scene.m_light.m_shadows) return;
    const auto draw = [&](const Matrix4& clip)
    {
        glUseProgram(m_depth.id());
        Uniforms{m_depth.id()}.set("clipFromScene", clip);
        glBindVertexArray(m_vertexArray.id());
        glDrawArrays(GL_TRIANGLES, 0, static_cast<int>(m_vertices.size()));
    };
    m_key.render(m_vertices, m_towardsKey, m_ground, 0.02, draw);
    m_sky.render(m_vertices, m_upwards, m_ground, kSkyReach, draw);
}

void SceneRenderer::Parts::setLight(const PictureScene& scene, const Uniforms& uniforms) const
{
    const CameraAxes a = axes(m_camera);
    const double side = dot(m_towardsKey, a.m_right) > 0 ? -1 : 1;  // fill light opposite to the key light
    uniforms.set("clipFromScene", m_clip);
    uniforms.set("eye", m_camera.m_eye);
    uniforms.set("upwards", m_upwards);
    uniforms.set("towardsKey", m_towardsKey);
    uniforms.set("towardsFill", unit(0.8 * side * a.m_right + 0.2 * m_upwards + 0.6 * a.m_back));
    uniforms.set("towardsRim", unit(0.35 * side * a.m_right + 0.6 * m_upwards - 0.8 * a.m_back));
    uniforms.set("shadows", scene.m_light.m_shadows);
    uniforms.set("lightSize", scene.m_light.m_size);
    uniforms.set("keyFromScene", m_key.mapFromScene());
    uniforms.set("keyWidth", m_key.width());
    uniforms.set("keyDepth", m_key.depth());
    uniforms.set("skyFromScene", m_sky.mapFromScene());
    uniforms.set("skyWidth", m_sky.width());
    uniforms.set("skyDepth", m_sky.depth());
    uniforms.set("wireWidth", std::max(1.0, m_size.m_height / 720.0));
    const std::pair<const char*, int> units[] = {
        {"colourMap", kMapUnit}, {"keyDepths", kKeyUnit}, {"keyShadow", kKeyShadowUnit}, {"skyDepths", kSkyUnit}};
    const unsigned textures[] = {m_colourMap.id(), m_key.texture(), m_key.texture(), m_sky.texture()};
    for (const auto& [name, textureUnit] : units)
    {
        uniforms.set(name, textureUnit);
        glActiveTexture(GL_TEXTURE0 + textureUnit);
        glBindTexture(GL_TEXTURE_2D, textures[textureUnit]);
    }
    glBindSampler(kKeyShadowUnit, m_shadowSampler.id());
}

void SceneRenderer::Parts::drawBackground(const PictureScene& scene) const
{
    const Uniforms uniforms{m_backgroundProgram.id()};
    glUseProgram(uniforms.m_program);
    uniforms.set("sky", scene.m_sky);
    uniforms.set("horizon", scene.m_horizon);
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(m_noVertices.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
}

void SceneRenderer::Parts::drawGround(const PictureScene& scene) const
{
    const Vec3& n = m_ground.m_normal;
    if (!m_ground.m_shown || dot(m_camera.m_eye - m_ground.m_point, n) <= 0) return;
    const Uniforms uniforms{m_groundProgram.id()};
    glUseProgram(uniforms.m_program);
    setLight(scene, uniforms);
    const Vec3 centre = dot(m_ground.m_point, n) * n;  // below the scene's centre, the origin
    const Vec3 side0 = unit(cross(std::abs(n.z) < 0.7 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}, n) * -1),
               side1 = cross(side0, n);
    const double spacing = scene.m_ground.m_gridSpacing / m_units.m_length;
    const auto phase = [&](const Vec3& side)
    { return std::remainder(dot(m_ground.m_point - centre, side), 5 * spacing); };
    uniforms.set("centre", centre);
    uniforms.set("side0", side0);
    uniforms.set("side1", side1);
    uniforms.set("extent", groundExtent(m_camera));
    uniforms.set("colour", scene.m_ground.m_colour);
    uniforms.set("spacing", spacing);
    if (spacing > 0) uniforms.set("gridOrigin", phase(side0), phase(side1));
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glBindVertexArray(m_noVertices.id());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_BLEND);
}

void SceneRenderer::Parts::drawSurfaces(const PictureScene& scene) const
{
    const Uniforms uniforms{m_surface.id()};
    glUseProgram(uniforms.m_program);
    setLight(scene, uniforms);
    glBindVertexArray(m_vertexArray.id());
    const auto draw = [&](bool arrows, double opacity)
    {
        uniforms.set("opacity", opacity);
        for (const Range& range : m_ranges)
        {
            if (range.m_arrows != arrows) continue;
            uniforms.set("colour", range.m_colour);
            uniforms.set("coloured", range.m_coloured);
            uniforms.set("lit", range.m_lit && opacity == 1);  // unlit inside bodies
            uniforms.set("wires", range.m_wires);
            glDrawArrays(GL_TRIANGLES, range.m_first, range.m_count);
        }
    };
    draw(false, 1);
    // First the parts of arrows hidden by surfaces: contact forces point into bodies.
    glEnable(GL_BLEND);
    glEnable(GL_CULL_FACE);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_GREATER);
    draw(true, kHiddenArrows);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    draw(true, 1);
}

SceneRenderer::SceneRenderer()
{
    if (epoxy_gl_version() < 33 || !epoxy_is_desktop_gl())
        throw std::runtime_error("picture: OpenGL 3.3 is needed, but the driver gives " +
                                 std::to_string(epoxy_gl_version() / 10) + "." +
                                 std::to_string(epoxy_gl_version() % 10));
    m_parts = std::make_unique<Parts>();
    checkGl("set-up");
}

SceneRenderer::~SceneRenderer() = default;

void SceneRenderer::setWireframe(bool all)
{
    m_parts->m_allWires = all;
}

void SceneRenderer::draw(const PictureScene& scene, const PictureCamera& camera, const PictureSize& size)
{
    std::string why;
    if (!valid(scene, camera, &why)) throw std::invalid_argument(why);
    int target = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
    m_parts->m_size = size;
    m_parts->place(scene, camera);
    m_parts->collect(scene);
    m_parts->drawLightMaps(scene);

    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<unsigned>(target));
    glViewport(0, 0, size.m_width, size.m_height);
    glDisable(GL_CULL_FACE);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_MULTISAMPLE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glClear(GL_DEPTH_BUFFER_BIT);
    m_parts->drawBackground(scene);
    m_parts->drawGround(scene);
    m_parts->drawSurfaces(scene);
    glBindSampler(kKeyShadowUnit, 0);
    m_parts->m_overlay.begin(size, legendTextHeight(scene, size));
    addLegend(scene, size, m_parts->m_overlay);
    m_parts->m_overlay.draw(m_parts->m_colourMap.id());
    checkGl("a picture");
}

}  // namespace bullet_fem
