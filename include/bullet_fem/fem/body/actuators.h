// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/symmetric.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

// Actuators drive a body by internal forces without resultant force or torque. Each acts along the gradient of a scalar
// q of the positions, the volume of a chamber or the length of a cable, with a force that depends on q alone: its
// stiffness is a single number, and a step takes it implicitly (docs/theory.md, Actuators).

/// The standard atmosphere [Pa].
constexpr double kStandardAtmosphere = 101325;

/// A gas chamber: a closed surface over nodes of the body.
struct BULLETFEM_API Chamber
{
    int m_id = 0;  ///< identifier set by the caller
    /// Oriented counter-clockwise seen from outside the gas, that is from inside the wall.
    std::vector<Triangle> m_triangles;
    bool m_isSealed = false;  ///< false: constant m_pressure; true: constant m_gas
    double m_pressure = 0;    ///< gauge pressure above m_outsidePressure [Pa], in [-m_outsidePressure, 1e8]
    /// Absolute pressure times volume, constant in a sealed gas at constant temperature [J], in [0, 1e12].
    double m_gas = 0;
    double m_outsidePressure = kStandardAtmosphere;  ///< [Pa], in [0, 1e8]

    /// Throws std::invalid_argument, naming value, range and remedy, on values out of range, a node outside the mesh, a
    /// surface that is not closed or spans several connected components of the mesh, and inconsistently oriented
    /// triangles.
    void validate(const TetMesh& mesh) const;

    /// Throws std::invalid_argument, naming the value and the remedy, if the volume at positions x [m], one per node,
    /// is not positive.
    void validateVolume(const std::vector<Vec3>& x) const;

    /// Enclosed volume [m3] at positions x [m], one per node; negative if the surface is inside out.
    double volume(const std::vector<Vec3>& x) const;

    /// Gauge pressure [Pa] at a volume [m3]. That of a sealed gas is limited to 1e8 Pa, also for volumes of zero or
    /// less.
    double pressureAt(double volume) const;
};

/// A point attached to up to four nodes.
struct CablePoint
{
    std::array<int, 4> m_nodes = {};                 ///< node indices; ignored where the weight is 0
    std::array<double, 4> m_weights = {1, 0, 0, 0};  ///< [-], sum 1

    Vec3 at(const std::vector<Vec3>& u) const;  ///< interpolation of u, one value per node
};

/// A cable, or tendon, through points of the body, in which it slides without friction: its tension is uniform. It
/// carries tension only.
struct BULLETFEM_API Cable
{
    int m_id = 0;                      ///< identifier set by the caller
    std::vector<CablePoint> m_points;  ///< at least two; the cable ends are fixed to the first and the last
    double m_tension = 0;              ///< constant tension [N], in [0, 1e9]; used if m_stiffness is 0
    double m_stiffness = 0;            ///< stiffness of an elastic cable [N/m], in [0, 1e12]
    double m_restLength = 0;           ///< rest length of an elastic cable [m], in [0, 1e6]

    /// Throws std::invalid_argument, naming value, range and remedy, on values out of range, fewer than two points, a
    /// node outside the mesh, weights whose sum is not 1, or points in several connected components of the mesh.
    void validate(const TetMesh& mesh) const;

    /// Length [m] at positions x [m], one per node.
    double length(const std::vector<Vec3>& x) const;

    /// Tension [N], >= 0, at a length [m].
    double tensionAt(double length) const;
};

/// Muscle fibres in a set of elements: the stress a f f^T along the unit fibre direction f, which rotates with the
/// element. A free bar of Young's modulus E shortens by a / E.
struct BULLETFEM_API Fibres
{
    int m_id = 0;                    ///< identifier set by the caller
    std::vector<int> m_elements;     ///< element indices of the mesh; empty: all
    std::vector<Vec3> m_directions;  ///< f in the rest shape, of any nonzero length: one for all, or one per element
    double m_activation = 0;         ///< a [Pa], in [-1e13, 1e13]; positive contracts

    /// Throws std::invalid_argument, naming value, range and remedy, on elements or values out of range.
    void validate(const TetMesh& mesh) const;
};

/// Isotropic expansion of a set of elements, as by heat (alpha dT), swelling or growth: the initial stress -3 K strain
/// I, K the bulk modulus; -C (strain I) for an orthotropic material.
struct BULLETFEM_API Expansion
{
    int m_id = 0;                 ///< identifier set by the caller
    std::vector<int> m_elements;  ///< element indices of the mesh; empty: all
    double m_strain = 0;          ///< free linear strain [-], in [-0.9, 9]

    /// Throws std::invalid_argument, naming value, range and remedy, on elements or values out of range.
    void validate(const TetMesh& mesh) const;
};

/// All actuators of a body, in the order in which they were added.
struct BULLETFEM_API Actuators
{
    std::vector<Chamber> m_chambers;      ///< gas chambers
    std::vector<Cable> m_cables;          ///< cables
    std::vector<Fibres> m_fibres;         ///< muscle fibres
    std::vector<Expansion> m_expansions;  ///< expansions
    /// Initial stress without that of fibres and expansions (applyActiveStress).
    std::vector<SymmetricTensor> m_ownStress;

    /// True if there are chambers or cables, which add forces and stiffness to the system of a step.
    bool hasPulls() const { return !m_chambers.empty() || !m_cables.empty(); }
    /// True if there are fibres or expansions, which add initial stress.
    bool hasActiveStress() const { return !m_fibres.empty() || !m_expansions.empty(); }

    /// Validates every actuator. Throws std::invalid_argument, naming value, range and remedy.
    void validate(const TetMesh& mesh) const;
};

/// Closed inner surfaces of a mesh, which enclose no elements, oriented as Chamber requires. Triangles are connected
/// over shared edges. Ordered by first triangle in the mesh's surface. Allocates.
BULLETFEM_API std::vector<std::vector<Triangle>> findCavities(const TetMesh& mesh);

/// Calls bytes(...) with every member of a Chamber: a ByteWriter appends them, a ByteReader reads them.
template <class Bytes>
void transfer(Bytes& bytes, Chamber& c)
{
    bytes(c.m_id, c.m_triangles, c.m_isSealed, c.m_pressure, c.m_gas, c.m_outsidePressure);
}

/// Calls bytes(...) with every member of a CablePoint: a ByteWriter appends them, a ByteReader reads them.
template <class Bytes>
void transfer(Bytes& bytes, CablePoint& p)
{
    bytes(p.m_nodes, p.m_weights);
}

/// Calls bytes(...) with every member of a Cable: a ByteWriter appends them, a ByteReader reads them.
template <class Bytes>
void transfer(Bytes& bytes, Cable& c)
{
    bytes(c.m_id, c.m_points, c.m_tension, c.m_stiffness, c.m_restLength);
}

/// Calls bytes(...) with every member of Fibres: a ByteWriter appends them, a ByteReader reads them.
template <class Bytes>
void transfer(Bytes& bytes, Fibres& f)
{
    bytes(f.m_id, f.m_elements, f.m_directions, f.m_activation);
}

/// Calls bytes(...) with every member of an Expansion: a ByteWriter appends them, a ByteReader reads them.
template <class Bytes>
void transfer(Bytes& bytes, Expansion& e)
{
    bytes(e.m_id, e.m_elements, e.m_strain);
}

/// Calls bytes(...) with every member of Actuators: a ByteWriter appends them, a ByteReader reads them.
template <class Bytes>
void transfer(Bytes& bytes, Actuators& a)
{
    bytes(a.m_chambers, a.m_cables, a.m_fibres, a.m_expansions, a.m_ownStress);
}

}  // namespace bullet_fem
