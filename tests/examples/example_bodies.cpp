// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "examples/example_bodies.h"

#include <algorithm>
#include <cmath>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "fem/common/rotation.h"
#include "plugin/scenes/tetgen_text.h"

namespace bullet_fem
{
namespace
{

constexpr double kTurn = 2 * 3.14159265358979323846;

// Deformation gradient of an element, and its rest volume.
struct Deformation
{
    Mat3 m_F;
    double m_restVolume;
};

Deformation deformationOf(const btSoftBody::Tetra& tet)
{
    const Vec3 x = vec3(tet.m_n[0]->m_x);
    const Mat3 edges =
        Mat3::fromColumns(vec3(tet.m_n[1]->m_x) - x, vec3(tet.m_n[2]->m_x) - x, vec3(tet.m_n[3]->m_x) - x);
    Mat3 inverseRest;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) inverseRest(i, j) = double(tet.m_Dm_inverse[i][j]);
    return {edges * inverseRest, 1 / (6 * std::fabs(determinant(inverseRest)))};
}

double bump(const Vec3& direction, const Vec3& toward, double width)
{
    const Vec3 away = direction - (1 / norm(toward)) * toward;
    return std::exp(-dot(away, away) / (width * width));
}

}  // namespace

TetMesh exampleCube()
{
    return makeBox({2, 2, 2}, {7, 7, 7}, {-1, -1, -1});
}

// A rod bent to a closed ring.
TetMesh exampleTorus()
{
    const int cells = 4, layers = 20;
    const double ring = 0.5, tube = 0.25;
    const TetMesh rod = makeCylinder(tube, 1, cells, layers);
    const int section = rod.nodeCount() / (layers + 1);
    std::vector<Vec3> positions;
    std::vector<int> node(rod.nodeCount());
    for (int i = 0; i < rod.nodeCount(); ++i)
    {
        const Vec3& X = rod.restPositions()[i];
        if (i >= layers * section)
        {
            node[i] = i - layers * section;
            continue;
        }
        node[i] = i;
        const double angle = kTurn * (X.z + 0.5), r = ring + X.x;
        positions.push_back({r * std::cos(angle), X.y, -r * std::sin(angle)});
    }
    std::vector<Tet> tets;
    for (const Tet& t : rod.tets()) tets.push_back({node[t[0]], node[t[1]], node[t[2]], node[t[3]]});
    return TetMesh(positions, tets);
}

SurfaceMesh lumpySurface()
{
    const int around = 24, along = 12;
    SurfaceMesh surface;
    const auto add = [&](double polar, double turn)
    {
        const Vec3 d = {std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn)};
        const double r = 1 + 0.06 * std::sin(3 * turn) * std::sin(2 * polar) + 0.45 * bump(d, {0.35, 0.8, 0.45}, 0.4) +
                         0.45 * bump(d, {-0.35, 0.8, 0.45}, 0.4) - 0.2 * bump(d, {0, 1, -0.2}, 0.5);
        surface.m_vertices.push_back({2.8 * r * d.x, 3.7 * r * d.y, 5.6 * r * d.z});
    };
    add(0, 0);
    for (int j = 1; j < along; ++j)
        for (int i = 0; i < around; ++i) add(kTurn / 2 * j / along, kTurn * i / around);
    add(kTurn / 2, 0);
    const int last = static_cast<int>(surface.m_vertices.size()) - 1;
    for (int i = 0; i < around; ++i)
    {
        const int next = (i + 1) % around, bottom = last - around;
        surface.m_triangles.push_back({0, 1 + next, 1 + i});
        surface.m_triangles.push_back({last, bottom + i, bottom + next});
        for (int j = 0; j + 2 < along; ++j)
        {
            const int a = 1 + j * around, b = a + around;
            surface.m_triangles.push_back({a + i, a + next, b + i});
            surface.m_triangles.push_back({a + next, b + next, b + i});
        }
    }
    return surface;
}

btSoftBody* createFromTetGenText(btSoftBodyWorldInfo& info, const TetMesh& mesh)
{
    const TetGenText text(mesh);
    return btSoftBodyHelpers::CreateFromTetGenData(info, text.m_elements.c_str(), nullptr, text.m_nodes.c_str(), false,
                                                   true, true);
}

double smallestVolumeRatio(const btSoftBody& body)
{
    double smallest = 1;
    for (int e = 0; e < body.m_tetras.size(); ++e)
        smallest = std::min(smallest, determinant(deformationOf(body.m_tetras[e]).m_F));
    return smallest;
}

namespace
{

// Energy density of the corotational linear law [J/m3].
double corotatedDensity(const Mat3& F, double lambda, double mu)
{
    const Mat3 S = transposeTimes(polarRotation(F, Mat3::identity()), F);
    const Mat3 strain = 0.5 * (S + transpose(S)) - Mat3::identity();
    return mu * squaredNorm(strain) + 0.5 * lambda * trace(strain) * trace(strain);
}

// Energy density of Ciarlet's Neo-Hookean law, for J above 0.1 [J/m3].
double neoHookeDensity(const Mat3& F, double lambda, double mu)
{
    const double J = determinant(F);
    return 0.5 * mu * (squaredNorm(F) - 3) + 0.25 * lambda * (J * J - 1) - (0.5 * lambda + mu) * std::log(J);
}

}  // namespace

double elasticEnergy(const btSoftBody& body, double young, double poisson, btFemElasticLaw law)
{
    const double mu = young / (2 * (1 + poisson)), lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
    double sum = 0;
    for (int e = 0; e < body.m_tetras.size(); ++e)
    {
        const Deformation d = deformationOf(body.m_tetras[e]);
        sum += d.m_restVolume * (law == btFemElasticLaw::neoHooke ? neoHookeDensity(d.m_F, lambda, mu)
                                                                  : corotatedDensity(d.m_F, lambda, mu));
    }
    return sum;
}

}  // namespace bullet_fem
