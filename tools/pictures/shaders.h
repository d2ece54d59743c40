// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

/// The renderer's shaders, GLSL 3.30 without #version. Lengths are in PictureUnits, colours sRGB where they enter and
/// leave.
namespace bullet_fem
{

/// Surfaces and arrows.
std::string surfaceVertexShader();
std::string surfaceFragmentShader();
/// Depth seen from a light.
std::string depthVertexShader();
std::string depthFragmentShader();
/// The ground: a square around the scene, fading out.
std::string groundVertexShader();
std::string groundFragmentShader();
/// The background over the whole picture.
std::string backgroundVertexShader();
std::string backgroundFragmentShader();
/// Flat things in pixels: legend and text.
std::string overlayVertexShader();
std::string overlayFragmentShader();

}  // namespace bullet_fem
