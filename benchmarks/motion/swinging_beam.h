// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "benchmarks/motion/motion_world.h"

namespace bullet_fem
{

/// The clamped beam of 4 x 1 x 1 m with 1,536 elements, 10 MPa, undamped, falling under its weight from rest.
struct FallingBeam
{
    std::vector<double> m_tipHeights;  ///< at every thirtieth of a second within the first second [m]
    double m_milliseconds = 0;         ///< processor time per step, median [ms]
};

/// `method` must not be rigid; `rate` [1/s] is a multiple of 30.
FallingBeam dropBeam(MotionMethod method, int rate);

/// Largest distance of the tips over the largest deflection of the reference [-].
double tipError(const FallingBeam& beam, const FallingBeam& reference);

/// Time [s] in which an undamped clamped beam of 192 elements, with a first bending mode of 1.7 Hz, loses half of its
/// amplitude by numerical damping. Extrapolated from the energy loss in ten seconds; infinite without loss.
Measured swingBeam(MotionMethod method, int rate);

}  // namespace bullet_fem
