// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cmath>
#include <vector>

namespace bullet_fem
{

/// Barycentric weights of points distributed evenly over a tet: the additive recurrence with the powers of 1 / g, g^4 =
/// g + 1 [Roberts 2018], in the unit cube, mapped to the tet so that volume ratios are preserved: planes parallel to
/// the face opposite node 0 divide the volume by the cube root, lines in them the area by the square root.
std::vector<std::array<double, 4>> spreadSamples(int count);

/// True if a point with this winding number is inside the solid.
inline bool isInside(double winding)
{
    return std::abs(winding) >= 0.5;
}

/// Volume sums of interior sample points.
struct FillTally
{
    double m_outward = 0, m_inward = 0;  ///< volume of positive and of negative winding number
    bool m_overlapping = false;          ///< a magnitude above 3/2 was found

    void add(double winding, double volume)
    {
        (winding > 0 ? m_outward : m_inward) += volume;
        if (std::abs(winding) > 1.5) m_overlapping = true;
    }
};

}  // namespace bullet_fem
