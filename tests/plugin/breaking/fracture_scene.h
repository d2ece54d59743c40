// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "bullet_fem/btFemFracture.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

enum class BarMesh
{
    regular,  ///< cubes of five or six tetrahedra
    shaken    ///< the same with inner nodes moved at random, so that no section is a plane of faces
};

/// A bar along x about the origin.
struct Bar
{
    Vec3 m_size = {2, 0.5, 0.5};             ///< [m]
    std::array<int, 3> m_cells = {8, 2, 2};  ///< along every axis
    BarMesh m_mesh = BarMesh::regular;
    std::function<bool(const Vec3& middle)> m_isLeftOut;  ///< tetrahedra that are not there; empty: all are
    btScalar m_youngModulus = btScalar(1e6);
    btScalar m_poissonRatio = 0;
    btScalar m_massDamping = 5;    ///< [1/s]
    bool m_isClampedLeft = false;  ///< at its lower end of x
};

inline TetMesh meshOf(const Bar& bar)
{
    const TetMesh whole = makeBox(bar.m_size, bar.m_cells, -0.5 * bar.m_size);
    std::vector<Vec3> X = whole.restPositions();
    std::mt19937 random(7);
    const auto draw = [&random] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
    if (bar.m_mesh == BarMesh::shaken)
        for (Vec3& x : X)
        {
            const Vec3 move = {draw(), draw(), draw()};
            for (int c = 0; c < 3; ++c)
                if (std::fabs(x[c]) < 0.5 * bar.m_size[c] - 1e-6) x[c] += 0.4 * bar.m_size[c] / bar.m_cells[c] * move[c];
        }
    if (!bar.m_isLeftOut) return TetMesh(X, whole.tets());
    std::vector<int> number(X.size(), -1);
    std::vector<Vec3> kept;
    std::vector<Tet> tets;
    for (Tet tet : whole.tets())
    {
        if (bar.m_isLeftOut(0.25 * (X[tet[0]] + X[tet[1]] + X[tet[2]] + X[tet[3]]))) continue;
        for (int& node : tet)
        {
            if (number[node] < 0)
            {
                number[node] = static_cast<int>(kept.size());
                kept.push_back(X[node]);
            }
            node = number[node];
        }
        tets.push_back(tet);
    }
    return TetMesh(kept, tets);
}

/// A bar in a world, FEM, without gravity unless it is given.
class BarScene
{
public:
    explicit BarScene(const Bar& bar, Coupling coupling = Coupling::swap, double gravity = 0,
                      const btFemSolverInfo& info = implicitEuler(), WorldClass worldClass = WorldClass::softRigid)
        : m_world(worldClass, coupling, {0, 0, btScalar(-gravity)}, info), m_right(0.5 * bar.m_size.x)
    {
        m_bar = btFemHelpers::createFromTetMesh(m_world.info(), meshOf(bar));
        for (int i = 0; bar.m_isClampedLeft && i < m_bar->m_nodes.size(); ++i)
            if (double(m_bar->m_nodes[i].m_x.x()) < -m_right + 1e-4) m_bar->setMass(i, 0);
        for (int t = 0; t < m_bar->m_faces.size(); ++t) addEndFace(m_bar->m_faces[t]);
        m_world.addSoft(m_bar);
        btFemMaterial material;
        material.m_youngModulus = bar.m_youngModulus;
        material.m_poissonRatio = bar.m_poissonRatio;
        material.m_massDamping = bar.m_massDamping;
        m_fem.setMaterial(m_bar, material);
        m_fem.prepare(m_bar, kStep);
    }

    void setStrength(double tension, int mostCracks = 1)
    {
        btFemTensileStrength strength;
        strength.m_tension = btScalar(tension);
        strength.m_mostCracks = mostCracks;
        btFemFracture::setStrength(m_fem, m_bar, strength);
    }

    /// A force along x on the face at the upper end of x, and its opposite at the lower end, in the next step [N].
    void pull(double force)
    {
        for (std::size_t k = 0; k < m_endNodes.size(); ++k)
            m_bar->m_nodes[m_endNodes[k]].m_f +=
                btVector3(btScalar(force * m_endShare[k] / (m_endShare[k] > 0 ? m_area : m_area)), 0, 0);
    }

    const btAlignedObjectArray<btFemSplit>& splits() const { return btFemFracture::splits(m_fem); }

    FemWorld m_world;
    btFemSoftBodySolver& m_fem = m_world.fem();
    btSoftBody* m_bar = nullptr;

private:
    void addEndFace(const btSoftBody::Face& face)
    {
        std::array<Vec3, 3> X;
        for (int a = 0; a < 3; ++a) X[a] = vec3(face.m_n[a]->m_x);
        const double side = X[0].x > 0 ? 1 : -1;
        for (const Vec3& x : X)
            if (std::fabs(x.x - side * m_right) > 1e-4) return;
        const double area = 0.5 * norm(cross(X[1] - X[0], X[2] - X[0]));
        if (side > 0) m_area += area;
        for (int a = 0; a < 3; ++a)
        {
            m_endNodes.push_back(static_cast<int>(face.m_n[a] - &m_bar->m_nodes[0]));
            m_endShare.push_back(side * area / 3);
        }
    }

    double m_right, m_area = 0;
    std::vector<int> m_endNodes;
    std::vector<double> m_endShare;  // of the area [m2]; negative at the lower end
};

}  // namespace bullet_fem
