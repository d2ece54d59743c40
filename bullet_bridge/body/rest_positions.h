// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

class btSoftBody;

namespace bullet_fem
{

/// The rest positions of a body's nodes.
struct RestPositions
{
    std::vector<Vec3> m_X;        ///< relative to node 0 [m]
    Vec3 m_origin;                ///< node 0 of the rest shape, aligned with the present one [m]
    bool m_fromMatrices = false;  ///< reconstructed from the elements' matrices; otherwise the present shape
};

/// The node indices of the tetrahedra. Throws std::invalid_argument if a pointer is not to a node of the body:
/// appendNode may reallocate the nodes and does not update the tetrahedra.
std::vector<Tet> tetsOf(const btSoftBody& body);

/// True if the body has that number of nodes, and these tetrahedra. Throws like tetsOf().
bool hasElements(const btSoftBody& body, std::size_t nodes, const std::vector<Tet>& tets);

/// Reconstructs the shape at the last initializeDmInverse from btSoftBody::Tetra::m_Dm_inverse. This requires that all
/// matrices are finite, regular and consistent with the rest volumes (m_element_measure), and that the traversal of
/// elements gives each node a single position. Each connected component is aligned with its present position and
/// rotation, so that both shapes differ by the deformation alone.
///
/// Returns the present positions, which are more precise, if these differ from that shape only by rigid motions of the
/// elements, up to single precision; and also if the matrices are not usable: they are zero if initializeDmInverse was
/// never called.
RestPositions restPositionsOf(const btSoftBody& body, const std::vector<Tet>& tets);

}  // namespace bullet_fem
