// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/soft_body_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/face_tree.h"
#include "bullet_bridge/body/rest_positions.h"

namespace bullet_fem
{

RestMesh restMeshOf(const btSoftBody& body)
{
    std::vector<Tet> tets = tetsOf(body);
    RestPositions rest = restPositionsOf(body, tets);
    return {TetMesh(std::move(rest.m_X), std::move(tets), LooseNodes::kept), rest.m_origin, rest.m_fromMatrices};
}

TetMesh tetMeshOf(const btSoftBody& body)
{
    return restMeshOf(body).m_mesh;
}

std::vector<double> filledFractionsOf(const btSoftBody& body)
{
    std::vector<double> filled(body.m_tetras.size(), 1.0);
    bool all = true;
    for (int e = 0; e < body.m_tetras.size(); ++e)
    {
        const double stored = body.m_tetras[e].m_c1;
        if (!(stored > 0 && stored < 1)) continue;
        filled[e] = stored;
        all = false;
    }
    if (all) filled.clear();
    return filled;
}

double massScaleOf(const btSoftBody& body)
{
    const double stored = body.m_tetras.size() > 0 ? double(body.m_tetras[0].m_c2) : 0;
    return stored > 0 && std::isfinite(stored) ? stored : 1;
}

namespace
{

// Faces for Bullet's rayTest, which tests the faces first, and then all sides of tetrahedra, which replace a hit if
// they are nearer by a rounding error. Starting a face with the first corner of the element's side makes both results
// bitwise equal.
std::vector<Triangle> facesOf(const TetMesh& mesh)
{
    std::vector<Triangle> faces = mesh.surface();
    const std::vector<unsigned char> sides = mesh.boundarySides();
    auto face = faces.begin();
    for (int e = 0; e < mesh.tetCount(); ++e)
        for (int a = 0; a < 4; ++a)
        {
            if (!(sides[e] >> a & 1)) continue;
            const int first = mesh.tets()[e][a == 0 ? 1 : 0];  // Bullet starts a side with its first node
            std::rotate(face->begin(), std::find(face->begin(), face->end(), first), face->end());
            ++face;
        }
    return faces;
}

}  // namespace

void makeFaces(btSoftBody& body, const TetMesh& mesh)
{
    if (body.m_faces.size() > 0) return;
    body.m_faces.reserve(static_cast<int>(mesh.surface().size()));
    for (const Triangle& t : facesOf(mesh)) body.appendFace(t[0], t[1], t[2]);
    body.updateNormals();
}

void makeTets(btSoftBody& body, const TetMesh& mesh)
{
    body.m_tetras.reserve(mesh.tetCount());
    for (const Tet& tet : mesh.tets()) body.appendTetra(tet[0], tet[1], tet[2], tet[3]);
    makeFaces(body, mesh);
    keepFaceTree(body);
    body.initializeDmInverse();
}

void storeFill(btSoftBody& body, int tet, double fraction, double massScale)
{
    body.m_tetras[tet].m_c1 = static_cast<btScalar>(fraction);
    body.m_tetras[tet].m_c2 = static_cast<btScalar>(massScale);
}

Material unsetMaterialOf(const btSoftBody& body)
{
    const btSoftBody::Material* spring = body.m_tetras.size() > 0 ? body.m_tetras[0].m_material : nullptr;
    const double kLST = spring ? std::clamp(double(spring->m_kLST), 1e-3, 1.0) : 1.0;
    Material material = withProgramDefaults({});
    material.m_youngModulus = 1e6 * (std::isfinite(kLST) ? kLST : 1.0);
    material.m_density = 0;
    return material;
}

void writeMasses(btSoftBody& body, const std::vector<double>& mass)
{
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (body.m_nodes[i].m_im != 0 && mass[i] > 0) body.m_nodes[i].m_im = static_cast<btScalar>(1 / mass[i]);
    body.m_bUpdateRtCst = true;
}

bool isMassless(btScalar inverseMass)
{
    return inverseMass > 0 && (std::isinf(inverseMass) || 1 / inverseMass == 0);
}

namespace
{

// True if the massless nodes are exactly those in no face, as after btSoftBody::setTotalMass by faces.
bool hasMassesByFaces(const btSoftBody& body, const std::vector<double>& volumeShare)
{
    std::vector<unsigned char> inFace(body.m_nodes.size(), 0);
    for (int f = 0; f < body.m_faces.size(); ++f)
        for (const btSoftBody::Node* node : body.m_faces[f].m_n) inFace[node - &body.m_nodes[0]] = 1;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (body.m_nodes[i].m_im != 0 && volumeShare[i] > 0 && isMassless(body.m_nodes[i].m_im) == (inFace[i] != 0))
            return false;
    return body.m_faces.size() > 0;
}

}  // namespace

std::vector<double> sanitisedMasses(const btSoftBody& body, const std::vector<double>& volumeShare, bool& repaired)
{
    const bool byFaces = hasMassesByFaces(body, volumeShare);
    double knownMass = 0, knownVolume = 0, masslessVolume = 0;
    std::vector<double> mass(volumeShare.size(), 0.0);
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const double inverse = body.m_nodes[i].m_im;
        if (byFaces && isMassless(body.m_nodes[i].m_im)) masslessVolume += volumeShare[i];
        const bool usable = inverse > 0 && std::isfinite(inverse) && std::isfinite(1 / inverse);
        repaired = repaired || !(usable || inverse == 0);
        if (!usable) continue;
        mass[i] = 1 / inverse;
        if (volumeShare[i] > 0) knownMass += mass[i];
        knownVolume += volumeShare[i];
    }
    const double density = knownVolume > 0 ? knownMass / (knownVolume + masslessVolume) : 1000;
    for (std::size_t i = 0; i < mass.size(); ++i)
    {
        if (masslessVolume > 0 && volumeShare[i] > 0) mass[i] = density * volumeShare[i];
        // the mass of a loose node is not used
        if (!(mass[i] > 0)) mass[i] = volumeShare[i] > 0 ? density * volumeShare[i] : 1;
    }
    return mass;
}

}  // namespace bullet_fem
