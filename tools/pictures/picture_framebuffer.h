// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/pictures/gl_objects.h"
#include "tools/pictures/image.h"

namespace bullet_fem
{

/// A multisampled framebuffer for pictures.
class PictureFramebuffer
{
public:
    /// Throws std::invalid_argument if the driver does not support `size`, std::runtime_error if memory is
    /// insufficient.
    explicit PictureFramebuffer(const PictureSize& size);

    const PictureSize& size() const { return m_size; }
    /// Binds the multisampled framebuffer for drawing.
    void bind() const;
    /// Averages the samples and binds the result, so that overlays can be drawn onto it.
    void resolve() const;
    /// Reads the result of the last `resolve` and later drawing.
    Image read() const;
    /// Copies the result to the framebuffer with the name `target`, which must have this size.
    void copyTo(unsigned target) const;

private:
    PictureSize m_size;
    GlObject m_samples, m_samplesColour, m_samplesDepth, m_result, m_resultColour;
};

}  // namespace bullet_fem
