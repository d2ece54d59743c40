// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

class btSoftBody;

// What drives a FEM body from within, as in soft robots and muscles: see docs/actuation.md. The forces have no sum and
// no torque. btFemSoftBodySolver has the functions that add, change and remove them.

/// A cavity with gas, or a liquid under pressure, in it.
struct BULLETFEM_API btFemChamber
{
    /// Nodes of the closed surface around the gas, three a triangle, counter-clockwise seen from outside the gas, which
    /// is from within the wall. All in one piece of the body.
    std::vector<int> m_triangles;
    bool m_sealed = false;    ///< false: m_pressure is kept, as by a pump; true: m_gas is
    btScalar m_pressure = 0;  ///< above m_outsidePressure [Pa], in [-m_outsidePressure, 1e8]
    /// Of a sealed chamber: absolute pressure times volume [J], in [0, 1e12], which stays as the volume changes
    /// (isothermal ideal gas: n R T).
    btScalar m_gas = 0;
    btScalar m_outsidePressure = btScalar(101325);  ///< [Pa], in [0, 1e8]; the standard atmosphere

    /// The cavities of a body: its closed inner surfaces, in the order of their first triangle in the boundary, without
    /// pressure. Throws std::invalid_argument (see btFemSoftBodySolver about `why`) on a body without usable
    /// tetrahedra.
    static bool find(const btSoftBody* body, std::vector<btFemChamber>& cavities, std::string* why = nullptr);
};

/// A point that a cable runs through: between up to four nodes of a body.
struct btFemCablePoint
{
    int m_nodes[4] = {0, 0, 0, 0};         ///< those without weight do not matter
    btScalar m_weights[4] = {1, 0, 0, 0};  ///< barycentric [-], sum 1

    btFemCablePoint() = default;  ///< at the first node
    /// At a node, in [0, m_nodes.size()) of the body.
    explicit btFemCablePoint(int node) { m_nodes[0] = node; }
};

/// A cable (tendon) through points of a body, in which it slides without friction: its tension is the same all along.
/// It pulls, and never pushes.
struct BULLETFEM_API btFemCable
{
    std::vector<btFemCablePoint> m_points;  ///< at least 2, in one piece of the body; it is fixed to the first and last
    btScalar m_tension = 0;                 ///< of a cable without stiffness [N], in [0, 1e9]
    btScalar m_stiffness = 0;               ///< of a cable that stretches [N/m], in [0, 1e12]; 0: m_tension is kept
    btScalar m_restLength = 0;              ///< of that: where it begins to pull [m], in [0, 1e6]
};

/// Muscle fibres in some tetrahedra: the stress a f f^T along the fibre f, which turns with its tetrahedron. A free bar
/// of Young's modulus E shortens by a / E.
struct BULLETFEM_API btFemFibres
{
    std::vector<int> m_tets;  ///< tetrahedra; none: all
    /// f in the rest shape, laid over the body as it was when first stepped or prepared: one for all, or one a
    /// tetrahedron, of any length > 0.
    std::vector<btVector3> m_directions;
    btScalar m_activation = 0;  ///< a [Pa], in [-1e13, 1e13]; positive draws together
};

/// Tetrahedra that are to be larger than their rest shape by the same strain along all axes: by heat (coefficient of
/// expansion times difference of temperature), swelling or growth.
struct BULLETFEM_API btFemExpansion
{
    std::vector<int> m_tets;  ///< tetrahedra; none: all
    btScalar m_strain = 0;    ///< [-], in [-0.9, 9]
};

/// Kinds of what drives a body.
enum class btFemActuatorKind
{
    chamber,
    cable,
    fibres,
    expansion
};

/// One of them, as it is now. What is of another kind is 0.
struct btFemActuatorReport
{
    btFemActuatorKind m_kind = btFemActuatorKind::chamber;  ///< what it is
    int m_actuator = 0;                                     ///< its handle
    btScalar m_volume = 0;                                  ///< of a chamber [m3]
    btScalar m_pressure = 0;                                ///< of it, above the outside pressure [Pa]
    btScalar m_length = 0;                                  ///< of a cable [m]
    btScalar m_tension = 0;                                 ///< of it [N], >= 0
    btScalar m_activation = 0;                              ///< of fibres [Pa]
    btScalar m_strain = 0;                                  ///< of an expansion [-]
};
