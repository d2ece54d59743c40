// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/image.h"

#include <stb_image_write.h>

#include <algorithm>
#include <new>

#include "fem/common/message.h"
#include "fem/common/output_file.h"

namespace bullet_fem
{

Image besideEachOther(const std::vector<Image>& images, int gap)
{
    if (images.empty()) reject("picture: a strip needs at least one image");
    int width = -gap;
    for (const Image& image : images)
    {
        if (image.m_size.m_height != images[0].m_size.m_height)
            reject("picture: a strip's images are ", images[0].m_size.m_height, " and ", image.m_size.m_height,
                   " pixels high; they must be equally high");
        width += image.m_size.m_width + gap;
    }
    Image strip({width, images[0].m_size.m_height});
    std::fill(strip.m_pixels.begin(), strip.m_pixels.end(), static_cast<unsigned char>(255));
    std::size_t left = 0;
    for (const Image& image : images)
    {
        const std::size_t stride = 3 * static_cast<std::size_t>(image.m_size.m_width);
        for (int y = 0; y < image.m_size.m_height; ++y)
            std::copy_n(image.m_pixels.data() + stride * y, stride,
                        strip.m_pixels.data() + 3 * static_cast<std::size_t>(width) * y + left);
        left += stride + 3 * static_cast<std::size_t>(gap);
    }
    return strip;
}

void writePng(const Image& image, const std::string& path)
{
    const PictureSize& size = image.m_size;
    if (size.m_width <= 0 || size.m_height <= 0 || image.m_pixels.size() != Image(size).m_pixels.size())
        reject("picture: the image for '", path, "' is ", size.m_width, " x ", size.m_height, " pixels with ",
               image.m_pixels.size(), " bytes; it must have pixels, 3 bytes each");
    std::string png;
    const auto append = [](void* to, void* bytes, int count)
    { static_cast<std::string*>(to)->append(static_cast<const char*>(bytes), static_cast<std::size_t>(count)); };
    if (!stbi_write_png_to_func(append, &png, size.m_width, size.m_height, 3, image.m_pixels.data(), 0))
        throw std::bad_alloc();
    writeOutputFile(path, png);
}

}  // namespace bullet_fem
