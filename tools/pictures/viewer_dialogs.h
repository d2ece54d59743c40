// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "tools/pictures/viewer_control.h"

namespace bullet_fem
{

/// @name Elements over the picture besides the panel
/// All calls go between ImGui's NewFrame and Render, for a picture of `size`.
/// @{

/// Shows the keys in the middle.
void showHelp(ViewerControl& control, const PictureSize& size);

/// Shows text, a bar and a cancel button near the bottom; nothing without work in progress. Returns the height used
/// above the caption [pixels]; sets `cancelled` when the button is pressed.
double showProgress(const ViewerProgress& progress, const PictureSize& size, bool& cancelled);

/// Shows sentences `above` the caption [pixels]; empty ones are omitted.
void showSentences(const std::vector<std::string>& sentences, const PictureSize& size, double above);

/// Shows a red dot at the top during recording.
void showFilming(const PictureSize& size);
/// @}

}  // namespace bullet_fem
