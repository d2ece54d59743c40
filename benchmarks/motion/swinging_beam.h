// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "benchmarks/motion/motion_world.h"

namespace bullet_fem
{

/// The clamped beam of 4 x 1 x 1 m, 1,536 elements and 10 MPa, undamped, that falls under its weight from rest.
struct FallingBeam
{
    std::vector<double> m_tipHeights;  ///< after every thirtieth of a second of the first one [m]
    double m_milliseconds = 0;         ///< processor time of a step, median [ms]
};

/// `method` is no rigid one; `rate` [1/s] is a multiple of 30.
FallingBeam dropBeam(MotionMethod method, int rate);

/// Largest distance of the tips over the largest deflection of the reference [-].
double tipError(const FallingBeam& beam, const FallingBeam& reference);

/// Time in which the swing of an undamped clamped beam of 192 elements, whose first bending mode has 1.7 Hz, loses half
/// of its amplitude [s], from what ten seconds take from its energy; infinite if they take nothing.
Measured swingBeam(MotionMethod method, int rate);

}  // namespace bullet_fem
