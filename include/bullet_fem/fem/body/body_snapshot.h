// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// All that the next steps of a body depend on: its state, what contact has learnt of it, and which factor it has.
struct BodySnapshot
{
    std::uint64_t m_shapeMark = 0;         ///< of the rest shape: mesh, filled fractions and material
    FactorPath m_path = FactorPath::full;  ///< of the factor
    FactorInput m_factor;  ///< m_step, m_mass, m_fixed; masses and fixed nodes are empty if they are those of the state
    double m_complianceScale = 1;                      ///< as in StepScratch [-], > 0
    std::vector<Vec3> m_x;                             ///< this and what follows as in BodyState [m]
    std::vector<Vec3> m_v;                             ///< [m/s]
    std::vector<double> m_mass;                        ///< [kg]
    std::vector<unsigned char> m_fixed;                ///< 1: the velocity is prescribed
    std::array<std::vector<Vec3>, 2> m_lastIncrement;  ///< [m/s]
    std::vector<Quaternion> m_elementRotation;         ///< one an element, and what fills the last block up
    Mat3 m_bodyRotation;                               ///< of Warp::global
    std::vector<SymmetricTensor> m_initialStress;      ///< [Pa]
    std::uint64_t m_initialStressChanges = 0;          ///< how often it was set
    std::vector<SymmetricTensor> m_plasticStrain;      ///< [-]
    std::vector<double> m_equivalentPlasticStrain;     ///< [-]
    std::vector<SymmetricTensor> m_relaxedStrain;      ///< [-]
    Actuators m_actuators;                             ///< chambers, cables, fibres
    double m_leastStep = 0;                            ///< [s]
    double m_mostStep = 0;                             ///< [s]
};

/// The same for the same elements at the same rest positions, to the bit, of the same material.
BULLETFEM_API std::uint64_t markOf(const RestShape& shape);

/// The same for the same materials of the same elements, whatever their regions are called.
BULLETFEM_API std::uint64_t markOf(const ElementMaterials& materials);

/// What the next steps of the body depend on, copied.
BULLETFEM_API BodySnapshot snapshotOf(const Body& body);

/// Throws std::invalid_argument, naming the value, unless the snapshot can be the state of a body with this model's
/// mesh.
BULLETFEM_API void check(const BodySnapshot& snapshot, const BodyModel& model);

/// What the body's factor was made for. After check().
BULLETFEM_API FactorInput factorInputOf(const BodySnapshot& snapshot);

/// Makes it the body's state, which must have the factor that the snapshot tells. After check(). Does not allocate.
BULLETFEM_API void restore(const BodySnapshot& snapshot, Body& body);

/// Reads or writes what a factor was made for: `bytes` is a ByteReader or ByteWriter.
template <class Bytes>
void transfer(Bytes& bytes, FactorInput& input)
{
    bytes(input.m_step, input.m_mass, input.m_fixed);
}

/// Likewise the constants and directions of an orthotropic material.
template <class Bytes>
void transfer(Bytes& bytes, Orthotropic& orthotropic)
{
    bytes(orthotropic.m_young, orthotropic.m_poisson, orthotropic.m_shear, orthotropic.m_along, orthotropic.m_across);
}

/// Likewise a material.
template <class Bytes>
void transfer(Bytes& bytes, Material& m)
{
    bytes(m.m_youngModulus, m.m_poissonRatio, m.m_density, m.m_massDamping, m.m_stiffnessDamping, m.m_meanDilatation,
          m.m_accurateBending, m.m_yieldStress, m.m_hardeningModulus, m.m_plasticCreep, m.m_mostPlasticStrain, m.m_law);
    for (PronyTerm& term : m.m_relaxation) bytes(term.m_share, term.m_time);
    if (m.isOrthotropic()) bytes(m.m_orthotropic);
}

/// Likewise.
template <class Bytes>
void transfer(Bytes& bytes, MaterialRegion& region)
{
    bytes(region.m_label, region.m_material);
}

/// Likewise.
template <class Bytes>
void transfer(Bytes& bytes, ElementMaterials& materials)
{
    bytes(materials.m_regions, materials.m_regionOf);
}

/// Likewise.
template <class Bytes>
void transfer(Bytes& bytes, BodySnapshot& s)
{
    bytes(s.m_shapeMark, s.m_path, s.m_factor, s.m_complianceScale, s.m_x, s.m_v, s.m_mass, s.m_fixed,
          s.m_lastIncrement, s.m_elementRotation, s.m_bodyRotation, s.m_initialStress, s.m_initialStressChanges,
          s.m_plasticStrain, s.m_equivalentPlasticStrain, s.m_relaxedStrain, s.m_actuators, s.m_leastStep,
          s.m_mostStep);
}

}  // namespace bullet_fem
