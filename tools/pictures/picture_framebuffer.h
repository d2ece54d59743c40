// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/pictures/gl_objects.h"
#include "tools/pictures/image.h"

namespace bullet_fem
{

/// Where pictures are drawn: a framebuffer with several samples a pixel, which are then averaged.
class PictureFramebuffer
{
public:
    /// Throws std::invalid_argument if the driver cannot draw `size`, std::runtime_error if there is no memory.
    explicit PictureFramebuffer(const PictureSize& size);

    const PictureSize& size() const { return m_size; }
    /// Binds the samples for drawing.
    void bind() const;
    /// Averages the samples, and binds the result, onto which more can be drawn.
    void resolve() const;
    /// The result of the last `resolve` with what was drawn since.
    Image read() const;
    /// Copies the result to the framebuffer with the name `target`, of the same size.
    void copyTo(unsigned target) const;

private:
    PictureSize m_size;
    GlObject m_samples, m_samplesColour, m_samplesDepth, m_result, m_resultColour;
};

}  // namespace bullet_fem
