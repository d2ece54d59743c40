// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "tools/pictures/picture_scene.h"

namespace bullet_fem
{

/// Draws scenes with OpenGL 3.3 core. The same scene, camera and size give the same pixels on the same driver.
/// The context that was current in the constructor must be current in all calls, the destructor among them.
class SceneRenderer
{
public:
    /// Throws std::runtime_error if the context is older than OpenGL 3.3 or a shader is not compiled.
    SceneRenderer();
    ~SceneRenderer();
    SceneRenderer(const SceneRenderer&) = delete;
    SceneRenderer& operator=(const SceneRenderer&) = delete;

    /// Draws the scene as seen by `camera` into the framebuffer that is bound for drawing, over all of its `size`. The
    /// scene's own camera is not used. Throws std::invalid_argument on a scene that is not `valid`.
    void draw(const PictureScene& scene, const PictureCamera& camera, const PictureSize& size);

    /// Whether all meshes show their edges from now on, not only those with m_wireframe.
    void setWireframe(bool all);

private:
    struct Parts;
    std::unique_ptr<Parts> m_parts;
};

}  // namespace bullet_fem
