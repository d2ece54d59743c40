// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "LinearMath/btScalar.h"
#include "bullet_fem/btFemReports.h"
#include "bullet_fem/fem/factor/body_model.h"

/// Set-up data of a baked body.
struct btFemBaked
{
    std::shared_ptr<const bullet_fem::BodyModel> m_model;
    std::uint64_t m_restMark = 0;  ///< hash of the element matrices at that time, to detect another rest shape
};

/// The definition of a FEM body independent of its state, which Bullet's serializer omits.
struct btFemDefinition
{
    std::vector<bullet_fem::Vec3> m_restPositions;  ///< relative to node 0 [m]
    bullet_fem::Vec3 m_restOrigin;                  ///< position of node 0 when the body became FEM [m]
    std::vector<std::array<int, 4>> m_tets;         ///< elements in the order of m_tetras
    std::vector<double> m_filled;                   ///< fraction of every element in (0, 1]; empty if all are 1
    double m_massScale = 1;                         ///< mass scale of a cage, > 0 [-]
    bullet_fem::ElementMaterials m_materials;
    std::vector<double> m_mass;           ///< per node, pinned ones included [kg]
    std::vector<btScalar> m_inverseMass;  ///< per node [1/kg]; 0: pinned
    double m_contactOffset = 0;           ///< [m]
    btFemDetail m_detail = btFemDetail::automatic;
};
