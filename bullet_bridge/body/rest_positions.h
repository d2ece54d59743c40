// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

class btSoftBody;

namespace bullet_fem
{

/// Where the nodes of a body are at rest.
struct RestPositions
{
    std::vector<Vec3> m_X;        ///< relative to node 0 [m]
    Vec3 m_origin;                ///< node 0 of the rest shape, laid over the present one [m]
    bool m_fromMatrices = false;  ///< the elements' matrices say so; else nothing does, and it is the present shape
};

/// The nodes that the tetrahedra join. Throws std::invalid_argument where they point to anything else: appendNode may
/// move the nodes, and leaves the tetrahedra's pointers behind.
std::vector<Tet> tetsOf(const btSoftBody& body);

/// True if the body has so many nodes, and these tetrahedra of them. Throws as tetsOf().
bool hasElements(const btSoftBody& body, std::size_t nodes, const std::vector<Tet>& tets);

/// The shape at the last initializeDmInverse, as far as it can be told from btSoftBody::Tetra::m_Dm_inverse: if all of
/// these are finite and regular, in keeping with the elements' rest volumes (m_element_measure), and, walking from
/// element to element, put every node in one place. Every connected piece is laid over its present place and turn, so
/// that they differ by the deformation alone.
///
/// Present positions are returned, because they are more exact, if they differ from that shape by rigid motions of the
/// elements only, to single precision; and also if the matrices are no good: bodies on which nobody called
/// initializeDmInverse have zeros there.
RestPositions restPositionsOf(const btSoftBody& body, const std::vector<Tet>& tets);

}  // namespace bullet_fem
