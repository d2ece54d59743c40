// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "LinearMath/btScalar.h"
#include "bullet_fem/btFemReports.h"
#include "bullet_fem/fem/common/vec3.h"
#include "bullet_fem/fem/mesh/material.h"

class btFemBodyRegistry;
class btSoftBody;
struct btFemEntry;

/// What makes a btSoftBody the FEM body that it is, whatever its state: what Bullet's serializer does not know.
struct btFemDefinition
{
    std::vector<bullet_fem::Vec3> m_restPositions;  ///< relative to node 0 [m]
    bullet_fem::Vec3 m_restOrigin;                  ///< of node 0 when the body became FEM [m]
    std::vector<std::array<int, 4>> m_tets;         ///< as the btSoftBody has them
    std::vector<double> m_filled;                   ///< fraction of every element in (0, 1]; empty if all are 1
    double m_massScale = 1;                         ///< of a cage, > 0 [-]
    bullet_fem::Material m_material;
    std::vector<double> m_mass;           ///< per node, of pinned ones too [kg]
    std::vector<btScalar> m_inverseMass;  ///< likewise [1/kg]; 0: pinned
    double m_contactOffset = 0;           ///< [m]
    btFemDetail m_detail = btFemDetail::automatic;
};

/// Writes the definition of a body. One that is not FEM yet is what it would become now. Throws std::invalid_argument
/// on null, or a body without usable tetrahedra.
void saveDefinition(const btFemBodyRegistry& registry, const btSoftBody* body, std::vector<unsigned char>& buffer);

/// Makes a body one of that definition when it is stepped or prepared next; its nodes stay where they are. Throws
/// std::invalid_argument, before it has changed anything, if that cannot be.
void applyDefinition(btFemBodyRegistry& registry, btSoftBody* body, const unsigned char* data, std::size_t size);
