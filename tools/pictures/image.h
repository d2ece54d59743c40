// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tools/pictures/camera.h"

namespace bullet_fem
{

/// Pixels of a picture.
struct Image
{
    PictureSize m_size{0, 0};
    std::vector<unsigned char> m_pixels;  ///< red, green, blue; rows from the top, each from left to right

    Image() = default;
    /// A black image.
    explicit Image(const PictureSize& size)
        : m_size(size), m_pixels(3 * static_cast<std::size_t>(size.m_width) * size.m_height)
    {
    }

    /// Red, green and blue of the pixel in column `x` and row `y`, which must be inside.
    std::array<int, 3> at(int x, int y) const
    {
        const unsigned char* p = &m_pixels[3 * (static_cast<std::size_t>(y) * m_size.m_width + x)];
        return {p[0], p[1], p[2]};
    }
};

/// Joins images of equal height from left to right with `gap` [pixels] of white between them: a film strip. Throws
/// std::invalid_argument if there are none or their heights differ.
Image besideEachOther(const std::vector<Image>& images, int gap);

/// Writes a PNG atomically: the file gets its name when complete, and an existing one stays until then. Equal images
/// give equal bytes. Throws std::invalid_argument on an empty image, std::runtime_error with the path if it cannot be
/// written, std::bad_alloc.
void writePng(const Image& image, const std::string& path);

}  // namespace bullet_fem
