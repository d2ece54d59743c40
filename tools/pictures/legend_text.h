// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "tools/pictures/picture_scene.h"

namespace bullet_fem
{

/// A number of a legend and where it stands.
struct LegendLabel
{
    double m_share = 0;  ///< 0 at the low end of the colour map, 1 at the high end
    std::string m_text;
};

/// The two ends of the scale and three numbers between them, with four digits, in the unit that legendTitle tells.
std::vector<LegendLabel> legendLabels(const PictureColourScale& scale);

/// The title with its unit: "von Mises stress [MPa]". Pa, N, J, W, m and s get the SI prefix that suits the range's
/// ends.
std::string legendTitle(const PictureColourScale& scale);

/// The same of arrows, and how far they go: "contact force [kN]" and "0 to 1.25", or "none yet".
std::string legendTitle(const PictureArrows& arrows);
std::string legendRange(const PictureArrows& arrows);

}  // namespace bullet_fem
