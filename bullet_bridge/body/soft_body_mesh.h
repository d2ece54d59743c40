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
    TetMesh m_mesh;        ///< node 0 is at the origin, so that bodies far away lose no precision; order of nodes and
                           ///< elements as in the body
    Vec3 m_origin;         ///< position of node 0 [m]
    bool m_known = false;  ///< from the body's element matrices; otherwise its present shape
};

/// The rest shape of a body by restPositionsOf(). Nodes without tetrahedra are kept as loose ones. Throws
/// std::invalid_argument like tetsOf() and TetMesh.
RestMesh restMeshOf(const btSoftBody& body);

/// The mesh of restMeshOf(). Throws like it.
TetMesh tetMeshOf(const btSoftBody& body);

/// Filled fraction of each element, as stored by a cage's helper (see storeFill); empty if all are 1.
std::vector<double> filledFractionsOf(const btSoftBody& body);

/// Factor of all masses that makes a cage as heavy as the volume of its surface; 1 for other bodies.
double massScaleOf(const btSoftBody& body);

/// Gives a body without faces those of the mesh's surface, for wind, pressure and drawing.
void makeFaces(btSoftBody& body, const TetMesh& mesh);

/// Gives a body of nodes alone a mesh's tetrahedra, faces with their tree, and rest matrices.
void makeTets(btSoftBody& body, const TetMesh& mesh);

/// Stores an element's filled fraction and the mass scale in btSoftBody::Tetra::m_c1 and m_c2, fields that Bullet
/// serialises and no longer uses. 0, their value after appendTetra, means 1.
void storeFill(btSoftBody& body, int tet, double fraction, double massScale);

/// Default material of a body without one: E = 1e6 kLST Pa (kLST in [1e-3, 1]), nu .3, beta .005 s, the body's masses.
Material unsetMaterialOf(const btSoftBody& body);

/// Writes node masses [kg] > 0 to the inverse masses of nodes that are not pinned.
void writeMasses(btSoftBody& body, const std::vector<double>& mass);

/// True for an infinite inverse mass: btSoftBody::setTotalMass by faces leaves it in nodes that are in no face.
bool isMassless(btScalar inverseMass);

/// Node masses [kg] from Bullet's inverse masses. Pinned nodes (inverse mass 0) get a share by volume at the body's
/// mean density. So do nodes with a negative, NaN or infinite inverse mass; this sets `repaired`. If the massless nodes
/// (isMassless) are those in no face, the total mass is that of the others, and is distributed to all nodes by volume.
/// A body without any mass gets 1000 kg/m3.
std::vector<double> sanitisedMasses(const btSoftBody& body, const std::vector<double>& volumeShare, bool& repaired);

}  // namespace bullet_fem
