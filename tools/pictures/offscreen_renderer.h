// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "tools/pictures/image.h"
#include "tools/pictures/picture_scene.h"

namespace bullet_fem
{

/// Draws pictures without display or window by EGL. Use it from one thread at a time; that thread must have no other
/// OpenGL context current during the calls. Between calls this object's context is not current.
class OffscreenRenderer
{
public:
    /// Throws std::runtime_error with installation advice if EGL or OpenGL 3.3 is missing.
    OffscreenRenderer();
    ~OffscreenRenderer();
    OffscreenRenderer(const OffscreenRenderer&) = delete;
    OffscreenRenderer& operator=(const OffscreenRenderer&) = delete;

    /// Draws the scene from its camera. Equal scenes give equal pixels. Throws std::invalid_argument on a scene that is
    /// not `valid` or a size that the driver does not support.
    Image render(const PictureScene& scene, const PictureSize& size = {});
    /// Name of the driver, such as "llvmpipe (LLVM 15.0.6, 256 bits)".
    std::string driver() const;

private:
    struct Context;
    struct Parts;
    std::unique_ptr<Context> m_context;
    std::unique_ptr<Parts> m_parts;
};

}  // namespace bullet_fem
