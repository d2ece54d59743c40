// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/picture_framebuffer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <stdexcept>

#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

constexpr int kSamples = 4;         // per pixel
constexpr int kLargestSide = 8192;  // [pixels]; takes 2 GB of samples

void checkSize(const PictureSize& size)
{
    int largest = 0, texture = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    largest = std::min({largest, texture, kLargestSide});
    const auto fits = [&](int n) { return n > 0 && n <= largest; };
    if (!fits(size.m_width) || !fits(size.m_height))
        reject("picture: the size is ", size.m_width, " x ", size.m_height, " pixels; each must be in [1, ", largest,
               "]");
}

void attach(const GlObject& renderbuffer, unsigned attachment, unsigned format, const PictureSize& size, int samples)
{
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer.id());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, size.m_width, size.m_height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, renderbuffer.id());
}

void checkComplete()
{
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error(
            "picture: the OpenGL driver offers no framebuffer of this size with 4 samples a pixel");
}

}  // namespace

PictureFramebuffer::PictureFramebuffer(const PictureSize& size)
    : m_size(size),
      m_samples(makeGlFramebuffer()),
      m_samplesColour(makeGlRenderbuffer()),
      m_samplesDepth(makeGlRenderbuffer()),
      m_result(makeGlFramebuffer()),
      m_resultColour(makeGlRenderbuffer())
{
    checkSize(size);
    glBindFramebuffer(GL_FRAMEBUFFER, m_result.id());
    attach(m_resultColour, GL_COLOR_ATTACHMENT0, GL_RGBA8, size, 0);
    checkComplete();
    glBindFramebuffer(GL_FRAMEBUFFER, m_samples.id());
    attach(m_samplesColour, GL_COLOR_ATTACHMENT0, GL_RGBA8, size, kSamples);
    attach(m_samplesDepth, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, size, kSamples);
    checkComplete();
    glClear(GL_COLOR_BUFFER_BIT);
    checkGl("making a framebuffer");
}

void PictureFramebuffer::bind() const
{
    glBindFramebuffer(GL_FRAMEBUFFER, m_samples.id());
}

void PictureFramebuffer::resolve() const
{
    glBindFramebuffer(GL_READ_FRAMEBUFFER, m_samples.id());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, m_result.id());
    glBlitFramebuffer(0, 0, m_size.m_width, m_size.m_height, 0, 0, m_size.m_width, m_size.m_height, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, m_result.id());
}

Image PictureFramebuffer::read() const
{
    Image image(m_size);
    std::vector<unsigned char> rows(image.m_pixels.size());  // OpenGL's first row is the bottom row
    glBindFramebuffer(GL_READ_FRAMEBUFFER, m_result.id());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, m_size.m_width, m_size.m_height, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
    const std::size_t stride = 3 * static_cast<std::size_t>(m_size.m_width);
    for (int y = 0; y < m_size.m_height; ++y)
        std::copy_n(rows.data() + stride * (m_size.m_height - 1 - y), stride, image.m_pixels.data() + stride * y);
    checkGl("reading a picture");
    return image;
}

void PictureFramebuffer::copyTo(unsigned target) const
{
    glBindFramebuffer(GL_READ_FRAMEBUFFER, m_result.id());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
    glBlitFramebuffer(0, 0, m_size.m_width, m_size.m_height, 0, 0, m_size.m_width, m_size.m_height, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
}

}  // namespace bullet_fem
