// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/pictures/overlay.h"

namespace bullet_fem
{

/// The overlay's text height that suits a picture of `size` [pixels].
double legendTextHeight(const PictureSize& size);
/// The same, as large as the scene wants it.
double legendTextHeight(const PictureScene& scene, const PictureSize& size);

/// From the lower edge, up to where the caption reaches [pixels].
double captionHeight(const PictureSize& size);

/// Adds the colour bar with title and numbers at the right border, if the scene has scalars, below it what arrows with
/// a title show, caption and title.
void addLegend(const PictureScene& scene, const PictureSize& size, Overlay& overlay);

}  // namespace bullet_fem
