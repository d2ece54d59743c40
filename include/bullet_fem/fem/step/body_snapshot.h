// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>

#include "bullet_fem/fem/step/body.h"

namespace bullet_fem
{

/// All that the next steps of a body depend on: its state, what contact has learnt of it, and which factor it has.
struct BodySnapshot
{
    std::uint64_t m_shapeMark = 0;  ///< of the rest shape: mesh, filled fractions and material
    FactorPath m_path = FactorPath::full;
    FactorInput m_factor;  ///< m_step, m_mass, m_fixed; masses and fixed nodes are empty if they are those of the state
    double m_complianceScale = 1;  ///< as in StepScratch [-], > 0
    std::vector<Vec3> m_x, m_v;    ///< and so on: as in BodyState
    std::vector<double> m_mass;
    std::vector<unsigned char> m_fixed;
    std::array<std::vector<Vec3>, 2> m_lastIncrement;
    std::vector<Quaternion> m_elementRotation;
    Mat3 m_bodyRotation;
};

/// The same for the same elements at the same rest positions, to the bit, of the same material.
std::uint64_t markOf(const RestShape& shape);

BodySnapshot snapshotOf(const Body& body);

/// Throws std::invalid_argument, naming the value, unless the snapshot can be the state of a body with this model's
/// mesh.
void check(const BodySnapshot& snapshot, const BodyModel& model);

/// What the body's factor was made for. After check().
FactorInput factorInputOf(const BodySnapshot& snapshot);

/// Makes it the body's state, which must have the factor that the snapshot tells. After check(). Does not allocate.
void restore(const BodySnapshot& snapshot, Body& body);

template <class Bytes>
void transfer(Bytes& bytes, FactorInput& input)
{
    bytes(input.m_step, input.m_mass, input.m_fixed);
}

template <class Bytes>
void transfer(Bytes& bytes, BodySnapshot& s)
{
    bytes(s.m_shapeMark, s.m_path, s.m_factor, s.m_complianceScale, s.m_x, s.m_v, s.m_mass, s.m_fixed,
          s.m_lastIncrement, s.m_elementRotation, s.m_bodyRotation);
}

}  // namespace bullet_fem
