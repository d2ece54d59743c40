// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{

constexpr double kBarLength = 0.2;  ///< of makeFreeBar() [m]

/// A bar of .2 x .03 x .03 m along x, centred at the origin, of Kuhn's six tetrahedra a cell.
TetMesh makeFreeBar(const std::array<int, 3>& cells = {12, 2, 2});

/// nu .3, 1000 kg/m3, with Young's modulus [Pa] and stiffness damping [s].
Material barMaterial(double young, double stiffnessDamping = 0.005);

/// Bends the rest shape of a body along x, centred at the origin, about z: its axis becomes an arc of `angle` [rad],
/// not 0, of its own length.
void bend(Body& body, double angle);

/// Twists the rest shape of a bar along x, centred at the origin, by `angle` [rad] over its length.
void twist(Body& body, double angle);

/// Rotates positions about the origin.
void rotate(Body& body, const Mat3& rotation);

/// Adds the velocities of a spin about the centre of mass [rad/s].
void spin(Body& body, const Vec3& omega);

/// Mass, momenta and inertia of a connected component.
struct RigidMotion
{
    double m_mass = 0;         ///< [kg]
    Vec3 m_center;             ///< [m]
    Vec3 m_linear;             ///< [kg m/s]
    Vec3 m_angular;            ///< about the centre [kg m2/s]
    Mat3 m_inertia;            ///< about the centre [kg m2]
    double m_linearSize = 0;   ///< sum m |v| [kg m/s]
    double m_angularSize = 0;  ///< sum m |r| |v| [kg m2/s]

    /// Angular velocity of the rigid part of the velocities [rad/s].
    Vec3 spin() const { return inverse(m_inertia) * m_angular; }
};

RigidMotion rigidMotionOf(const Body& body, int component = 0);

/// Subtracts from impulses on a body of one component those of a rigid motion, so that neither their sum nor their
/// torque about the centre remains.
void equilibrate(const Body& body, std::vector<Vec3>& impulses);

/// Names in the names of tests: of a modulus 10^n [Pa], and of the step with a numerical damping.
std::string nameOfYoung(double young);
std::string nameOfDamping(double numericalDamping);

}  // namespace bullet_fem
