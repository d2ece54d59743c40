// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "tools/pictures/picture_scene.h"

namespace bullet_fem
{

/// A number of a legend and its position.
struct LegendLabel
{
    double m_share = 0;  ///< 0 at the low end of the colour map, 1 at the high end
    std::string m_text;
};

/// The limits of the scale and three numbers between them, with four digits, in the unit of legendTitle.
std::vector<LegendLabel> legendLabels(const PictureColourScale& scale);

/// The title with its unit: "von Mises stress [MPa]". Pa, N, J, W, m and s get the SI prefix that suits the limits.
std::string legendTitle(const PictureColourScale& scale);

/// Title and range of the arrows: "contact force [kN]" and "0 to 1.25", or "none yet".
std::string legendTitle(const PictureArrows& arrows);
std::string legendRange(const PictureArrows& arrows);

}  // namespace bullet_fem
