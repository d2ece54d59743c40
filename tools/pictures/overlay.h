// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "tools/pictures/gl_objects.h"
#include "tools/pictures/picture_scene.h"

namespace bullet_fem
{

/// Where a text stands relative to its place.
enum class TextAlignment
{
    left,
    right,
    centre
};

/// A rectangle in pixels, from its upper left corner.
struct PictureRectangle
{
    double m_x = 0, m_y = 0, m_width = 0, m_height = 0;
};

/// Flat things over a picture: collected between `begin` and `draw`, which needs the context that the constructor had.
class Overlay
{
public:
    Overlay();

    /// Starts anew for a picture of `size` with letters `textHeight` [pixels] high.
    void begin(const PictureSize& size, double textHeight);
    void rectangle(const PictureRectangle& area, const Colour& colour, double opacity);
    /// The colour map, from its low end at the bottom to its high end at the top.
    void colourBar(const PictureRectangle& area);
    /// Text with its base line's end or middle at `place`. Characters that the font atlas lacks become '?'.
    void text(const PicturePoint& place, const std::string& utf8, TextAlignment alignment, const Colour& colour);
    /// How wide `utf8` will be [pixels].
    double textWidth(const std::string& utf8) const;
    /// Draws all into the bound framebuffer, which has the size given to `begin`.
    void draw(unsigned colourMapTexture);

private:
    struct Corner
    {
        float m_position[2], m_texel[2], m_colour[4];
    };
    struct Glyph
    {
        float m_low[2], m_high[2], m_texelLow[2], m_texelHigh[2], m_advance;
    };
    void makeGlyphs(double height);
    const Glyph& glyph(unsigned code) const;
    static void append(std::vector<Corner>& corners, const Corner& low, const Corner& high);

    GlObject m_program, m_vertexArray, m_buffer, m_glyphTexture;
    std::vector<Glyph> m_glyphs;
    double m_glyphHeight = 0;
    PictureSize m_size;
    std::vector<Corner> m_plain, m_letters, m_bars;
};

}  // namespace bullet_fem
