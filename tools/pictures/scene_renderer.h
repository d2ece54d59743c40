// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "tools/pictures/picture_scene.h"

namespace bullet_fem
{

/// Draws scenes with OpenGL 3.3 core. Equal scene, camera and size give equal pixels on one driver. The context
/// that was current in the constructor must be current in all calls, including the destructor.
class SceneRenderer
{
public:
    /// Throws std::runtime_error if the context is older than OpenGL 3.3 or a shader does not compile.
    SceneRenderer();
    ~SceneRenderer();
    SceneRenderer(const SceneRenderer&) = delete;
    SceneRenderer& operator=(const SceneRenderer&) = delete;

    /// Draws the scene from `camera` into the bound framebuffer, over all of its `size`; the scene's own camera is
    /// ignored. Throws std::invalid_argument on a scene that is not `valid`.
    void draw(const PictureScene& scene, const PictureCamera& camera, const PictureSize& size);

    /// Shows the edges of all meshes if `all`, else only of those with m_wireframe.
    void setWireframe(bool all);

private:
    struct Parts;
    std::unique_ptr<Parts> m_parts;
};

}  // namespace bullet_fem
