// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>

#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{

/// Two jaws without friction that compress a cube along z by a hundredth of its height: uniaxial stress.
struct JawMotion
{
    static constexpr double kClosing = 0.01;  ///< of the height [-]
    static constexpr double kGap = 0.01;      ///< between cube and jaws at the start, both sides, of the height [-]
    static constexpr double kBegin = 0.2, kClosed = 1.2, kAtRest = 2, kEnd = 2.5;  ///< [s]
    static constexpr int kCells = 4;                                               ///< along the cube

    double m_height = 1;  ///< of the cube [m]

    /// Distance of a jaw from the middle [m].
    double distanceAt(double time) const
    {
        const double share = std::clamp((time - kBegin) / (kClosed - kBegin), 0.0, 1.0);
        return m_height / 2 * (1 + kGap - (kGap + kClosing) * share);
    }

    /// Of a jaw [m/s].
    double speed() const { return m_height / 2 * (kGap + kClosing) / (kClosed - kBegin); }

    /// E A strain [N].
    double force(double young) const { return young * m_height * m_height * kClosing; }

    /// The cube around a point on the z axis.
    TetMesh mesh(double z = 0) const
    {
        return makeBox({m_height, m_height, m_height}, {kCells, kCells, kCells},
                       {-m_height / 2, -m_height / 2, z - m_height / 2});
    }
};

}  // namespace bullet_fem
