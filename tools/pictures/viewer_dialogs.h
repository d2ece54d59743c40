// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "tools/pictures/viewer_control.h"

namespace bullet_fem
{

/// @name What stands over the picture, besides the panel
/// All between ImGui's NewFrame and Render, for a picture of `size`.
/// @{

/// The keys, in the middle.
void showHelp(ViewerControl& control, const PictureSize& size);

/// Words and a bar, below, with a button that gives up. Nothing where nothing is done. Returns the height that it takes
/// above the caption [pixels], and sets `cancelled` when the button is pressed.
double showProgress(const ViewerProgress& progress, const PictureSize& size, bool& cancelled);

/// Sentences, `above` the caption [pixels]; empty ones are left out.
void showSentences(const std::vector<std::string>& sentences, const PictureSize& size, double above);

/// A red dot at the top, while a film is made.
void showFilming(const PictureSize& size);
/// @}

}  // namespace bullet_fem
