// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// The complete state that a body's next steps depend on: state, what was learnt in contact about its compliance, and
/// the inputs of its factor.
struct BodySnapshot
{
    std::uint64_t m_shapeMark = 0;         ///< hash of the rest shape: mesh, filled fractions and materials
    FactorPath m_path = FactorPath::full;  ///< path of the factor
    /// m_step, m_mass and m_fixed of the factor; masses and fixed nodes are empty if equal to those of the state.
    FactorInput m_factor;
    double m_complianceScale = 1;                      ///< as in StepScratch [-], > 0
    int m_presentSteps = 0;                            ///< as in StepScratch, >= 0
    std::vector<Vec3> m_x;                             ///< positions, as in BodyState [m]
    std::vector<Vec3> m_v;                             ///< velocities [m/s]
    std::vector<double> m_mass;                        ///< node masses [kg]
    std::vector<unsigned char> m_fixed;                ///< 1: the velocity is prescribed
    std::array<std::vector<Vec3>, 2> m_lastIncrement;  ///< [m/s]
    std::vector<Quaternion> m_elementRotation;         ///< one per element, then padding of the last kernel block
    Mat3 m_bodyRotation;                               ///< rotation of Warp::global
    std::vector<SymmetricTensor> m_initialStress;      ///< [Pa]
    std::uint64_t m_initialStressChanges = 0;          ///< number of changes of m_initialStress
    std::vector<SymmetricTensor> m_plasticStrain;      ///< [-]
    std::vector<double> m_equivalentPlasticStrain;     ///< [-]
    std::vector<SymmetricTensor> m_relaxedStrain;      ///< [-]
    std::vector<double> m_lawHistory;                  ///< history variables of the laws
    Actuators m_actuators;                             ///< chambers, cables, fibres
    double m_leastStep = 0;                            ///< minimum of the recent steps [s]
    double m_mostStep = 0;                             ///< maximum of the recent steps [s]
};

/// Hash of a rest shape: equal for equal elements, bitwise equal rest positions and filled fractions, and equal
/// materials.
BULLETFEM_API std::uint64_t markOf(const RestShape& shape);

/// Hash of a mesh's materials: equal if every element has equal material, whatever the region labels.
BULLETFEM_API std::uint64_t markOf(const ElementMaterials& materials);

/// Copies the state that the body's next steps depend on. Allocates.
BULLETFEM_API BodySnapshot snapshotOf(const Body& body);

/// Throws std::invalid_argument, naming the value, unless the snapshot is a valid state of a body with this model's
/// mesh.
BULLETFEM_API void check(const BodySnapshot& snapshot, const BodyModel& model);

/// The inputs of the body's factor, with masses and fixed nodes filled in. Requires check().
BULLETFEM_API FactorInput factorInputOf(const BodySnapshot& snapshot);

/// Restores the snapshot's state to a body, which must have the snapshot's factor. Requires check(). Does not allocate.
BULLETFEM_API void restore(const BodySnapshot& snapshot, Body& body);

/// Reads or writes the compared members of a FactorInput: `bytes` is a ByteReader or ByteWriter.
template <class Bytes>
void transfer(Bytes& bytes, FactorInput& input)
{
    bytes(input.m_step, input.m_mass, input.m_fixed);
}

/// Reads or writes constants and directions of an orthotropic material: `bytes` is a ByteReader or ByteWriter.
template <class Bytes>
void transfer(Bytes& bytes, Orthotropic& orthotropic)
{
    bytes(orthotropic.m_young, orthotropic.m_poisson, orthotropic.m_shear, orthotropic.m_along, orthotropic.m_across);
}

/// Reads or writes a material: `bytes` is a ByteReader or ByteWriter.
template <class Bytes>
void transfer(Bytes& bytes, Material& m)
{
    bytes(m.m_youngModulus, m.m_poissonRatio, m.m_density, m.m_massDamping, m.m_stiffnessDamping, m.m_meanDilatation,
          m.m_bending, m.m_yieldStress, m.m_hardeningModulus, m.m_plasticCreep, m.m_mostPlasticStrain, m.m_law);
    for (PronyTerm& term : m.m_relaxation) bytes(term.m_share, term.m_time);
    if (m.isOrthotropic()) bytes(m.m_orthotropic);
    bytes(m.m_lawConstants);
}

/// Reads or writes a region: `bytes` is a ByteReader or ByteWriter.
template <class Bytes>
void transfer(Bytes& bytes, MaterialRegion& region)
{
    bytes(region.m_label, region.m_material);
}

/// Reads or writes regions and region indices: `bytes` is a ByteReader or ByteWriter.
template <class Bytes>
void transfer(Bytes& bytes, ElementMaterials& materials)
{
    bytes(materials.m_regions, materials.m_regionOf);
}

/// Reads or writes a snapshot: `bytes` is a ByteReader or ByteWriter.
template <class Bytes>
void transfer(Bytes& bytes, BodySnapshot& s)
{
    bytes(s.m_shapeMark, s.m_path, s.m_factor, s.m_complianceScale, s.m_presentSteps, s.m_x, s.m_v, s.m_mass, s.m_fixed,
          s.m_lastIncrement, s.m_elementRotation, s.m_bodyRotation, s.m_initialStress, s.m_initialStressChanges,
          s.m_plasticStrain, s.m_equivalentPlasticStrain, s.m_relaxedStrain, s.m_lawHistory, s.m_actuators,
          s.m_leastStep, s.m_mostStep);
}

}  // namespace bullet_fem
