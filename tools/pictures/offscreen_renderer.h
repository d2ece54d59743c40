// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "tools/pictures/image.h"
#include "tools/pictures/picture_scene.h"

namespace bullet_fem
{

/// Draws pictures without any display or window, through EGL. Used by one thread at a time, which must have no other
/// OpenGL context current during the calls; between them none of ours is.
class OffscreenRenderer
{
public:
    /// Throws std::runtime_error, saying what to install, if there is no EGL or no OpenGL 3.3.
    OffscreenRenderer();
    ~OffscreenRenderer();
    OffscreenRenderer(const OffscreenRenderer&) = delete;
    OffscreenRenderer& operator=(const OffscreenRenderer&) = delete;

    /// The scene as its camera sees it. Equal scenes give equal pixels. Throws std::invalid_argument on a scene that is
    /// not `valid` or a size that the driver cannot draw.
    Image render(const PictureScene& scene, const PictureSize& size = {});
    /// What draws: the driver's own name, such as "llvmpipe (LLVM 15.0.6, 256 bits)".
    std::string driver() const;

private:
    struct Context;
    struct Parts;
    std::unique_ptr<Context> m_context;
    std::unique_ptr<Parts> m_parts;
};

}  // namespace bullet_fem
