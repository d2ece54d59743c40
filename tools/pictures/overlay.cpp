// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/overlay.h"

#include <epoxy/gl.h>
#include <stb_truetype.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "tools/pictures/font.h"
#include "tools/pictures/shaders.h"

namespace bullet_fem
{
namespace
{

constexpr int kAtlas = 1024;                  // side of the glyph texture [texels]
constexpr unsigned kFirst = 32, kLast = 255;  // ASCII and Latin-1, which includes superscripts and the micro sign
constexpr double kLargestText = 48;           // [pixels], limited by the atlas

/// Decodes the next character of `text` and advances `i`. Invalid bytes give '?'.
unsigned nextCode(const std::string& text, std::size_t& i)
{
    const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
    const unsigned first = byte(i++);
    if (first < 0x80) return first;
    unsigned code = '?';
    if ((first & 0xe0) == 0xc0 && (byte(i) & 0xc0) == 0x80) code = (first & 0x1f) << 6 | (byte(i) & 0x3f);
    while ((byte(i) & 0xc0) == 0x80) ++i;
    return code;
}

float f(double d)
{
    return static_cast<float>(d);
}

}  // namespace

Overlay::Overlay()
    : m_program(makeGlProgram(overlayVertexShader(), overlayFragmentShader())),
      m_vertexArray(makeGlVertexArray()),
      m_buffer(makeGlBuffer()),
      m_glyphTexture(makeGlTexture())
{
    glBindVertexArray(m_vertexArray.id());
    glBindBuffer(GL_ARRAY_BUFFER, m_buffer.id());
    const auto attribute = [](unsigned index, int parts, std::size_t offset)
    {
        glEnableVertexAttribArray(index);
        glVertexAttribPointer(index, parts, GL_FLOAT, GL_FALSE, sizeof(Corner), reinterpret_cast<const void*>(offset));
    };
    attribute(0, 2, offsetof(Corner, m_position));
    attribute(1, 2, offsetof(Corner, m_texel));
    attribute(2, 4, offsetof(Corner, m_colour));
}

void Overlay::makeGlyphs(double height)
{
    std::vector<unsigned char> pixels(kAtlas * kAtlas);
    std::vector<stbtt_packedchar> packed(kLast - kFirst + 1);
    stbtt_pack_context context;
    stbtt_PackBegin(&context, pixels.data(), kAtlas, kAtlas, 0, 1, nullptr);
    const int all = stbtt_PackFontRange(&context, embeddedFont(), 0, f(height), kFirst, static_cast<int>(packed.size()),
                                        packed.data());
    stbtt_PackEnd(&context);
    if (!all) throw std::runtime_error("picture: the font does not fit its texture");
    m_glyphs.clear();
    for (std::size_t i = 0; i < packed.size(); ++i)
    {
        stbtt_aligned_quad q;
        float x = 0, y = 0;
        stbtt_GetPackedQuad(packed.data(), kAtlas, kAtlas, static_cast<int>(i), &x, &y, &q, 1);
        m_glyphs.push_back({{q.x0, q.y0}, {q.x1, q.y1}, {q.s0, q.t0}, {q.s1, q.t1}, packed[i].xadvance});
    }
    glBindTexture(GL_TEXTURE_2D, m_glyphTexture.id());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kAtlas, kAtlas, 0, GL_RED, GL_UNSIGNED_BYTE, pixels.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    m_glyphHeight = height;
}

const Overlay::Glyph& Overlay::glyph(unsigned code) const
{
    return m_glyphs[(code >= kFirst && code <= kLast ? code : '?') - kFirst];
}

void Overlay::begin(const PictureSize& size, double textHeight)
{
    m_size = size;
    const double height = std::min(std::max(textHeight, 6.0), kLargestText);
    if (height != m_glyphHeight) makeGlyphs(height);
    m_plain.clear();
    m_letters.clear();
    m_bars.clear();
}

void Overlay::append(std::vector<Corner>& corners, const Corner& low, const Corner& high)
{
    Corner right = low, below = low;
    right.m_position[0] = high.m_position[0];
    right.m_texel[0] = high.m_texel[0];
    below.m_position[1] = high.m_position[1];
    below.m_texel[1] = high.m_texel[1];
    for (const Corner& c : {low, below, high, low, high, right}) corners.push_back(c);
}

void Overlay::rectangle(const PictureRectangle& area, const Colour& colour, double opacity)
{
    Corner low{{f(area.m_x), f(area.m_y)}, {0, 0}, {f(colour.r), f(colour.g), f(colour.b), f(opacity)}}, high = low;
    high.m_position[0] += f(area.m_width);
    high.m_position[1] += f(area.m_height);
    append(m_plain, low, high);
}

void Overlay::colourBar(const PictureRectangle& area)
{
    const auto end = [&](double y, float share)
    {
        Corner left{{f(area.m_x), f(y)}, {share, 0}, {1, 1, 1, 1}}, right = left;
        right.m_position[0] += f(area.m_width);
        return std::make_pair(left, right);
    };
    const auto top = end(area.m_y, 1), bottom = end(area.m_y + area.m_height, 0);
    for (const Corner& c : {top.first, bottom.first, bottom.second, top.first, bottom.second, top.second})
        m_bars.push_back(c);
}

double Overlay::textWidth(const std::string& utf8) const
{
    double width = 0;
    for (std::size_t i = 0; i < utf8.size();) width += glyph(nextCode(utf8, i)).m_advance;
    return width;
}

void Overlay::text(const PicturePoint& place, const std::string& utf8, TextAlignment alignment, const Colour& colour)
{
    const double share = alignment == TextAlignment::left ? 0 : alignment == TextAlignment::right ? 1 : 0.5;
    double x = place.m_x - share * textWidth(utf8);
    const float y = f(std::round(place.m_y));
    for (std::size_t i = 0; i < utf8.size();)
    {
        const Glyph& g = glyph(nextCode(utf8, i));
        const float start = f(std::round(x));
        const auto corner = [&](const float* at, const float* texel) {
            return Corner{{start + at[0], y + at[1]}, {texel[0], texel[1]}, {f(colour.r), f(colour.g), f(colour.b), 1}};
        };
        append(m_letters, corner(g.m_low, g.m_texelLow), corner(g.m_high, g.m_texelHigh));
        x += g.m_advance;
    }
}

void Overlay::draw(unsigned colourMapTexture)
{
    const unsigned program = m_program.id();
    glUseProgram(program);
    glBindVertexArray(m_vertexArray.id());
    glBindBuffer(GL_ARRAY_BUFFER, m_buffer.id());
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glUniform2f(glGetUniformLocation(program, "size"), f(m_size.m_width), f(m_size.m_height));
    glUniform1i(glGetUniformLocation(program, "glyphs"), 0);
    glUniform1i(glGetUniformLocation(program, "colourMap"), 1);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, colourMapTexture);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, m_glyphTexture.id());
    const std::vector<Corner>* const kinds[] = {&m_plain, &m_letters, &m_bars};
    for (const int kind : {0, 2, 1})
    {
        const std::vector<Corner>& corners = *kinds[kind];
        if (corners.empty()) continue;
        glUniform1i(glGetUniformLocation(program, "kind"), kind);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(Corner)), corners.data(),
                     GL_STREAM_DRAW);
        glDrawArrays(GL_TRIANGLES, 0, static_cast<int>(corners.size()));
    }
    glDisable(GL_BLEND);
}

}  // namespace bullet_fem
