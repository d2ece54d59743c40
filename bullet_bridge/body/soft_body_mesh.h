// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btScalar.h"
#include "bullet_fem/fem/mesh/material.h"
#include "bullet_fem/fem/mesh/rest_shape.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

class btSoftBody;

namespace bullet_fem
{

/// The tetrahedra of a btSoftBody in their rest shape.
struct RestMesh
{
    TetMesh m_mesh;  ///< node 0 at the origin, so that bodies far away lose nothing; nodes and elements in their order
    Vec3 m_origin;   ///< where node 0 is then [m]
    bool m_known = false;  ///< the body's element matrices say so; else its present shape was taken
};

/// See restPositionsOf. Nodes that no tetrahedron uses are kept as loose ones. Throws std::invalid_argument, see tetsOf
/// and TetMesh.
RestMesh restMeshOf(const btSoftBody& body);

/// The mesh alone.
TetMesh tetMeshOf(const btSoftBody& body);

/// Filled fraction of every element as a cage's helper stored it (see storeFill); empty if all are 1.
std::vector<double> filledFractionsOf(const btSoftBody& body);

/// Factor on all masses that makes a cage as heavy as its surface's volume; 1 for other bodies.
double massScaleOf(const btSoftBody& body);

/// Gives a body that has no faces those of the mesh's surface, which wind, pressure and drawing go by.
void makeFaces(btSoftBody& body, const TetMesh& mesh);

/// Stores an element's filled fraction and the mass scale in btSoftBody::Tetra::m_c1 and m_c2, fields that Bullet
/// serialises and no longer uses. 0, their value after appendTetra, means 1.
void storeFill(btSoftBody& body, int tet, double fraction, double massScale);

/// What a body is made of while nobody has said so: E = 1e6 kLST Pa (kLST in [1e-3, 1]), nu .3, beta .005 s, own
/// masses.
Material unsetMaterialOf(const btSoftBody& body);

/// Writes masses [kg] > 0 to the inverse masses of the nodes that are not pinned.
void writeMasses(btSoftBody& body, const std::vector<double>& mass);

/// True for an infinite inverse mass: btSoftBody::setTotalMass leaves that in nodes that are in no face.
bool isMassless(btScalar inverseMass);

/// Node masses [kg] from Bullet's inverse masses. Pinned nodes (inverse mass 0) get their share of the volume at the
/// body's mean density; so do nodes whose inverse mass is negative, NaN or infinite, and then `repaired` is set. If the
/// nodes without mass (isMassless) are those in no face, the mass of the others is the body's, and is shared out to all
/// of them by volume. A body of no mass at all is given 1000 kg/m3.
std::vector<double> sanitisedMasses(const btSoftBody& body, const std::vector<double>& volumeShare, bool& repaired);

}  // namespace bullet_fem
