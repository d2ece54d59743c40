// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

/// Shaders of the renderer, GLSL 3.30 without #version. Lengths are in PictureUnits; input and output colours are sRGB.
namespace bullet_fem
{

/// Surfaces and arrows.
std::string surfaceVertexShader();
std::string surfaceFragmentShader();
/// Depth seen from a light.
std::string depthVertexShader();
std::string depthFragmentShader();
/// The ground: a square around the scene that fades out.
std::string groundVertexShader();
std::string groundFragmentShader();
/// The background of the whole picture.
std::string backgroundVertexShader();
std::string backgroundFragmentShader();
/// Flat shapes in pixels: legend and text.
std::string overlayVertexShader();
std::string overlayFragmentShader();

}  // namespace bullet_fem
