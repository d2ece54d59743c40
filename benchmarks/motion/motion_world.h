// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

/// What moves the bodies.
enum class MotionMethod
{
    euler,        ///< numerical damping 1
    secondOrder,  ///< numerical damping 0
    rigid         ///< Bullet's rigid bodies
};

/// A value and what a step took.
struct Measured
{
    double m_value = 0;
    double m_milliseconds = 0;  ///< processor time of stepSimulation, or of the step of the beam alone; median [ms]
};

/// Largest speed with which an undamped rubber ball of 0.25 m radius and 1 MPa returns from a fall of a metre, over
/// that with which it meets a static box [-], mean of four falls that meet it in different phases of the step. `rate`
/// [1/s]; `cells` along the ball, in [2, 1000].
Measured dropBall(MotionMethod method, int rate, int cells);

/// Speed of a ball of 0.25 m radius, 1 MPa, damping 0.005 s and friction 0.8 after six seconds down a plane [m/s].
Measured rollBall(MotionMethod method, int rate, int cells, double degrees);

/// What a rigid sphere has then without slip, 5/7 g t sin(angle) [m/s].
double speedOfRigidSphere(double degrees);

}  // namespace bullet_fem
