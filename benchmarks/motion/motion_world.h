// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

constexpr double kBallYoung = 1e6;  ///< [Pa]

/// Time integrator.
enum class MotionMethod
{
    euler,        ///< numerical damping 1
    secondOrder,  ///< numerical damping 0
    standard,     ///< default settings
    rigid         ///< Bullet's rigid bodies
};

/// A result and the time of its steps.
struct Measured
{
    double m_value = 0;
    double m_milliseconds = 0;  ///< processor time of stepSimulation, or of the beam's step alone; median [ms]
};

/// Coefficient of restitution [-] of an undamped rubber ball of 0.25 m radius and modulus `young` [Pa] on a static box
/// after a fall of a metre: largest rebound speed over impact speed, mean of four falls whose impacts differ in phase
/// within the step. `rate` [1/s]; `cells` along the ball, in [2, 1000].
Measured dropBall(MotionMethod method, int rate, int cells, double young = kBallYoung);

/// Speed [m/s] of a ball of 0.25 m radius, 1 MPa, damping 0.005 s and friction 0.8 after rolling down a plane for six
/// seconds.
Measured rollBall(MotionMethod method, int rate, int cells, double degrees);

/// Speed of a rigid sphere that rolls without slip for that time, 5/7 g t sin(angle) [m/s].
double speedOfRigidSphere(double degrees);

}  // namespace bullet_fem
