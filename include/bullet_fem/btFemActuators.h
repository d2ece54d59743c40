// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

class btSoftBody;

// Actuators drive a FEM body by internal forces, as in soft robots and muscles (docs/actuation.md). The forces have no
// resultant force and no resultant torque. btFemSoftBodySolver has the functions that add, change and remove them.

/// A cavity filled with gas, or with a liquid under pressure.
struct BULLETFEM_API btFemChamber
{
    /// Node indices of the closed surface around the gas, three per triangle, counter-clockwise seen from outside the
    /// gas, that is from inside the wall. All nodes must be in one connected component of the body.
    std::vector<int> m_triangles;
    bool m_sealed = false;    ///< false: constant m_pressure, as by a pump; true: constant m_gas
    btScalar m_pressure = 0;  ///< gauge pressure above m_outsidePressure [Pa], in [-m_outsidePressure, 1e8]
    /// Absolute pressure times volume of a sealed chamber [J], in [0, 1e12], constant while the volume changes
    /// (isothermal ideal gas: n R T).
    btScalar m_gas = 0;
    /// Absolute pressure outside [Pa], in [0, 1e8]; default: the standard atmosphere.
    btScalar m_outsidePressure = btScalar(101325);

    /// Finds the cavities of a body: its closed inner surfaces, in the order of their first triangle in the boundary,
    /// with gauge pressure 0. Throws std::invalid_argument (see btFemSoftBodySolver about `why`) on a body without
    /// usable tetrahedra. Allocates.
    static bool find(const btSoftBody* body, std::vector<btFemChamber>& cavities, std::string* why = nullptr);
};

/// A point of a cable, a weighted mean of up to four nodes of a body.
struct btFemCablePoint
{
    int m_nodes[4] = {0, 0, 0, 0};         ///< node indices; ignored where the weight is 0
    btScalar m_weights[4] = {1, 0, 0, 0};  ///< barycentric [-], sum 1

    btFemCablePoint() = default;  ///< at node 0
    /// At a node with index in [0, m_nodes.size()) of the body.
    explicit btFemCablePoint(int node) { m_nodes[0] = node; }
};

/// A cable (tendon) through points of a body, in which it slides without friction: its tension is uniform. It carries
/// tension only.
struct BULLETFEM_API btFemCable
{
    /// At least 2, in one connected component of the body; the cable ends are fixed to the first and the last.
    std::vector<btFemCablePoint> m_points;
    btScalar m_tension = 0;     ///< constant tension [N], in [0, 1e9]; used if m_stiffness is 0
    btScalar m_stiffness = 0;   ///< stiffness of an elastic cable [N/m], in [0, 1e12]; 0: constant m_tension
    btScalar m_restLength = 0;  ///< rest length of an elastic cable, slack below it [m], in [0, 1e6]
};

/// Muscle fibres in a set of tetrahedra: the stress a f f^T along the unit fibre direction f, which rotates with the
/// tetrahedron. A free bar of Young's modulus E shortens by a / E.
struct BULLETFEM_API btFemFibres
{
    std::vector<int> m_tets;  ///< tetrahedron indices; empty: all
    /// Directions f in the rest shape, in world axes as the body lay when first stepped or prepared: one for all
    /// tetrahedra, or one per entry of m_tets, of any nonzero length.
    std::vector<btVector3> m_directions;
    btScalar m_activation = 0;  ///< a [Pa], in [-1e13, 1e13]; positive contracts
};

/// Isotropic expansion of a set of tetrahedra, as by heat (coefficient of expansion times temperature difference),
/// swelling or growth.
struct BULLETFEM_API btFemExpansion
{
    std::vector<int> m_tets;  ///< tetrahedron indices; empty: all
    btScalar m_strain = 0;    ///< free linear strain [-], in [-0.9, 9]
};

/// Kinds of actuators.
enum class btFemActuatorKind
{
    chamber,
    cable,
    fibres,
    expansion
};

/// The present state of an actuator. Members that belong to other kinds are 0.
struct btFemActuatorReport
{
    btFemActuatorKind m_kind = btFemActuatorKind::chamber;  ///< kind of the actuator
    int m_actuator = 0;                                     ///< handle, as returned when it was added
    btScalar m_volume = 0;                                  ///< volume of a chamber [m3]
    btScalar m_pressure = 0;                                ///< gauge pressure of a chamber [Pa]
    btScalar m_length = 0;                                  ///< length of a cable [m]
    btScalar m_tension = 0;                                 ///< tension of a cable [N], >= 0
    btScalar m_activation = 0;                              ///< activation of fibres [Pa]
    btScalar m_strain = 0;                                  ///< free strain of an expansion [-]
};
