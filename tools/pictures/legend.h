// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/pictures/overlay.h"

namespace bullet_fem
{

/// Default text height for a picture of `size` [pixels].
double legendTextHeight(const PictureSize& size);
/// The default text height times the scene's m_textSize [pixels].
double legendTextHeight(const PictureScene& scene, const PictureSize& size);

/// Height of the caption's upper edge above the lower border [pixels].
double captionHeight(const PictureSize& size);

/// Adds the colour bar with title and numbers at the right border if the scene has scalars, below it the legend of
/// arrows with a title, then caption and title.
void addLegend(const PictureScene& scene, const PictureSize& size, Overlay& overlay);

}  // namespace bullet_fem
