// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "tools/pictures/gl_objects.h"
#include "tools/pictures/picture_scene.h"

namespace bullet_fem
{

/// Alignment of a text relative to its position.
enum class TextAlignment
{
    left,
    right,
    centre
};

/// A rectangle in pixels; its position is the upper left corner.
struct PictureRectangle
{
    double m_x = 0, m_y = 0, m_width = 0, m_height = 0;
};

/// Flat shapes and text over a picture, collected between `begin` and `draw`. `draw` needs the context that was current
/// in the constructor.
class Overlay
{
public:
    Overlay();

    /// Starts an overlay for a picture of `size` with letters `textHeight` [pixels] high.
    void begin(const PictureSize& size, double textHeight);
    void rectangle(const PictureRectangle& area, const Colour& colour, double opacity);
    /// Adds the colour map, with its low end at the bottom.
    void colourBar(const PictureRectangle& area);
    /// Adds text with its base line's start, middle or end at `place`. Characters missing in the font atlas become '?'.
    void text(const PicturePoint& place, const std::string& utf8, TextAlignment alignment, const Colour& colour);
    /// Width of the text [pixels].
    double textWidth(const std::string& utf8) const;
    /// Draws the overlay into the bound framebuffer, which must have the size given to `begin`.
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
