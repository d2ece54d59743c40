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

// What drives a body from within, by forces that have no sum and no torque. Each pulls along the gradient of a scalar q
// of the positions, the volume of a chamber or the length of a cable, with a force that depends on q alone, so that its
// stiffness is one number: a step takes it implicitly (docs/theory.md, Actuators).

/// The standard atmosphere [Pa].
constexpr double kStandardAtmosphere = 101325;

/// A cavity with gas in it: a closed surface over nodes of the body.
struct BULLETFEM_API Chamber
{
    int m_id = 0;                       ///< the caller's
    std::vector<Triangle> m_triangles;  ///< counter-clockwise seen from outside the gas, which is from within the wall
    bool m_isSealed = false;            ///< false: m_pressure is kept; true: m_gas is
    double m_pressure = 0;              ///< above m_outsidePressure [Pa], in [-m_outsidePressure, 1e8]
    double m_gas =
        0;  ///< absolute pressure times volume, which a sealed gas keeps at one temperature [J], in [0, 1e12]
    double m_outsidePressure = kStandardAtmosphere;  ///< [Pa], in [0, 1e8]

    /// Throws std::invalid_argument, naming value, range and remedy, on values out of range, a node that the mesh has
    /// not, a surface that is not closed or not all in one piece of the mesh, or triangles that disagree about the
    /// inside.
    void validate(const TetMesh& mesh) const;

    /// Throws std::invalid_argument likewise if the volume at positions x is not above zero.
    void validateVolume(const std::vector<Vec3>& x) const;

    /// At positions x [m3]; negative where the surface is inside out.
    double volume(const std::vector<Vec3>& x) const;

    /// Above the outside pressure at that volume [Pa]. A sealed gas has at most 1e8 Pa, also where its volume is zero
    /// or below.
    double pressureAt(double volume) const;
};

/// A point that moves with up to four nodes.
struct CablePoint
{
    std::array<int, 4> m_nodes = {};                 ///< of the mesh; only those with a weight are looked at
    std::array<double, 4> m_weights = {1, 0, 0, 0};  ///< [-], sum 1

    Vec3 at(const std::vector<Vec3>& u) const;  ///< of u at the nodes, by the weights
};

/// A cable, or tendon, that runs through points of the body and slides in them without friction, so that its tension is
/// the same all along. It pulls, and never pushes.
struct BULLETFEM_API Cable
{
    int m_id = 0;                      ///< the caller's
    std::vector<CablePoint> m_points;  ///< at least two; the cable is fixed to the first and the last
    double m_tension = 0;              ///< where m_stiffness is 0 [N], in [0, 1e9]
    double m_stiffness = 0;            ///< of a cable that stretches [N/m], in [0, 1e12]
    double m_restLength = 0;           ///< where that is taut [m], in [0, 1e6]

    /// Throws std::invalid_argument, naming value, range and remedy, on values out of range, fewer than two points, a
    /// node that the mesh has not, weights that do not have the sum 1, or points in several pieces of the mesh.
    void validate(const TetMesh& mesh) const;

    /// At positions x [m].
    double length(const std::vector<Vec3>& x) const;

    /// At that length [N], >= 0.
    double tensionAt(double length) const;
};

/// Muscle fibres in some elements: the stress a f f^T along the fibre f, which turns with its element. A free bar of
/// Young's modulus E shortens by a / E.
struct BULLETFEM_API Fibres
{
    int m_id = 0;                    ///< the caller's
    std::vector<int> m_elements;     ///< in the mesh's order; none: all
    std::vector<Vec3> m_directions;  ///< f in the rest shape, of any length > 0: one for all, or one an element
    double m_activation = 0;         ///< a [Pa], in [-1e13, 1e13]; positive draws together

    /// Throws std::invalid_argument, naming value, range and remedy.
    void validate(const TetMesh& mesh) const;
};

/// Elements that are larger than their rest shape by a strain that is the same along all axes, as heat (alpha dT),
/// swelling or growth makes it: the stress -3 K strain I, K the bulk modulus.
struct BULLETFEM_API Expansion
{
    int m_id = 0;                 ///< the caller's
    std::vector<int> m_elements;  ///< in the mesh's order; none: all
    double m_strain = 0;          ///< [-], in [-0.9, 9]

    /// Throws std::invalid_argument, naming value, range and remedy.
    void validate(const TetMesh& mesh) const;
};

/// All that drives a body.
struct BULLETFEM_API Actuators
{
    std::vector<Chamber> m_chambers;           ///< in the order in which they were added, as all of them
    std::vector<Cable> m_cables;               ///< likewise
    std::vector<Fibres> m_fibres;              ///< likewise
    std::vector<Expansion> m_expansions;       ///< likewise
    std::vector<SymmetricTensor> m_ownStress;  ///< the initial stress without those of fibres and expansions; see there

    /// Whether something changes the system that a step solves.
    bool hasPulls() const { return !m_chambers.empty() || !m_cables.empty(); }
    /// Whether something gives elements a stress.
    bool hasActiveStress() const { return !m_fibres.empty() || !m_expansions.empty(); }

    /// Throws std::invalid_argument, naming value, range and remedy.
    void validate(const TetMesh& mesh) const;
};

/// The closed inner surfaces of a mesh, which enclose no material of it, turned as Chamber wants them; in the order of
/// their first triangle in the mesh's surface. Triangles belong together that share an edge.
BULLETFEM_API std::vector<std::vector<Triangle>> findCavities(const TetMesh& mesh);

/// Calls bytes(...) with every member: a ByteWriter appends them, a ByteReader reads them.
template <class Bytes>
void transfer(Bytes& bytes, Chamber& c)
{
    bytes(c.m_id, c.m_triangles, c.m_isSealed, c.m_pressure, c.m_gas, c.m_outsidePressure);
}

/// Calls bytes(...) with every member: a ByteWriter appends them, a ByteReader reads them.
template <class Bytes>
void transfer(Bytes& bytes, CablePoint& p)
{
    bytes(p.m_nodes, p.m_weights);
}

/// Calls bytes(...) with every member: a ByteWriter appends them, a ByteReader reads them.
template <class Bytes>
void transfer(Bytes& bytes, Cable& c)
{
    bytes(c.m_id, c.m_points, c.m_tension, c.m_stiffness, c.m_restLength);
}

/// Calls bytes(...) with every member: a ByteWriter appends them, a ByteReader reads them.
template <class Bytes>
void transfer(Bytes& bytes, Fibres& f)
{
    bytes(f.m_id, f.m_elements, f.m_directions, f.m_activation);
}

/// Calls bytes(...) with every member: a ByteWriter appends them, a ByteReader reads them.
template <class Bytes>
void transfer(Bytes& bytes, Expansion& e)
{
    bytes(e.m_id, e.m_elements, e.m_strain);
}

/// Calls bytes(...) with every member: a ByteWriter appends them, a ByteReader reads them.
template <class Bytes>
void transfer(Bytes& bytes, Actuators& a)
{
    bytes(a.m_chambers, a.m_cables, a.m_fibres, a.m_expansions, a.m_ownStress);
}

}  // namespace bullet_fem
