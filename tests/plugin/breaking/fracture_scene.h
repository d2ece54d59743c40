// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "bullet_bridge/body/rest_positions.h"
#include "bullet_fem/btFemFracture.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "fem/common/disjoint_sets.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

enum class BarMesh
{
    regular,  ///< cubes of five or six tetrahedra
    shaken    ///< with inner nodes moved at random, so that no section is a plane of faces
};

/// A bar along x about the origin.
struct Bar
{
    Vec3 m_size = {2, 0.5, 0.5};             ///< [m]
    std::array<int, 3> m_cells = {8, 2, 2};  ///< along every axis
    BarMesh m_mesh = BarMesh::regular;
    double m_slit = 0;  ///< x of a slit across the upper half, between cells; 0: none [m]
    btScalar m_youngModulus = btScalar(1e6);
    btScalar m_poissonRatio = 0;
    btScalar m_massDamping = 5;    ///< mass damping [1/s]
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
                if (std::fabs(x[c]) < 0.5 * bar.m_size[c] - 1e-6)
                    x[c] += 0.4 * bar.m_size[c] / bar.m_cells[c] * move[c];
        }
    std::vector<Tet> tets = whole.tets();
    const auto isOnSlit = [&](const Vec3& x) { return std::fabs(x.x - bar.m_slit) < 1e-6 && x.z > 1e-6; };
    std::vector<int> copy(bar.m_slit != 0 ? X.size() : 0, -1);
    for (Tet& tet : tets)
        for (int a = 0; a < 4 && bar.m_slit != 0; ++a)
        {
            const int node = whole.tets()[&tet - &tets[0]][a];
            const Vec3 middle = 0.25 * (X[tet[0]] + X[tet[1]] + X[tet[2]] + X[tet[3]]);
            if (!isOnSlit(X[node]) || middle.x < bar.m_slit) continue;
            if (copy[node] < 0) copy[node] = static_cast<int>(X.size()), X.push_back(X[node]);
            tet[a] = copy[node];
        }
    return TetMesh(X, tets);
}

/// A FEM bar in a world, without gravity unless it is given.
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
        material.m_bending = btFemBending::plain;
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

    /// Applies a force along x to the face at the upper end of x, and its opposite at the lower end, in the next step
    /// [N].
    void pull(double force)
    {
        for (std::size_t k = 0; k < m_endNodes.size(); ++k)
            m_bar->m_nodes[m_endNodes[k]].m_f += btVector3(btScalar(force * m_endShare[k] / m_area), 0, 0);
    }

    /// Increases the force until the bar splits or the force reaches `largest`; returns the last force [N].
    double pullUntilItSplits(double largest, double seconds = 4)
    {
        double force = 0;
        for (int k = 1; force < largest && splits().size() == 0; ++k)
        {
            force = largest * k / (60 * seconds);
            pull(force);
            m_world.step();
        }
        return force;
    }
    /// Continues with that force until the bar is in two parts, for a second at most.
    void pullInTwo(double force)
    {
        for (int k = 0; k < 60 && parts() < 2; ++k)
        {
            pull(force);
            m_world.step();
        }
    }

    const btAlignedObjectArray<btFemSplit>& splits() const { return btFemFracture::splits(m_fem); }
    int parts() const { return splits().size() > 0 ? splits()[splits().size() - 1].m_parts : 1; }

    /// Per node: the lowest node index of its part.
    std::vector<int> partOfNodes() const
    {
        DisjointSets sets(m_bar->m_nodes.size());
        for (const Tet& tet : tetsOf(*m_bar))
            for (int a = 1; a < 4; ++a) sets.join(tet[0], tet[a]);
        std::vector<int> part;
        for (int i = 0; i < m_bar->m_nodes.size(); ++i) part.push_back(sets.root(i));
        return part;
    }
    /// For two parts: 1 for nodes of the part at larger x.
    std::vector<int> isRight() const
    {
        const std::vector<int> part = partOfNodes();
        Vec3 sum[2];
        int count[2] = {0, 0};
        std::vector<int> side;
        for (int i = 0; i < m_bar->m_nodes.size(); ++i)
        {
            side.push_back(part[i] != part[0]);
            sum[side[i]] += vec3(m_bar->m_nodes[i].m_x);
            ++count[side[i]];
        }
        if (sum[0].x / count[0] > sum[1].x / count[1])
            for (int& s : side) s = 1 - s;
        return side;
    }
    /// Smallest x of the right part minus largest x of the left one [m].
    double gap() const
    {
        const std::vector<int> right = isRight();
        double low = 1e30, high = -1e30;
        for (int i = 0; i < m_bar->m_nodes.size(); ++i)
            if (right[i])
                low = std::min(low, double(m_bar->m_nodes[i].m_x.x()));
            else
                high = std::max(high, double(m_bar->m_nodes[i].m_x.x()));
        return low - high;
    }
    double rightMass() const
    {
        const std::vector<int> right = isRight();
        double mass = 0;
        for (int i = 0; i < m_bar->m_nodes.size(); ++i)
            if (right[i]) mass += 1 / double(m_bar->m_nodes[i].m_im);
        return mass;
    }

    /// Bits of the bar's whole visible state, and its splits.
    std::vector<btScalar> bits() const
    {
        std::vector<btScalar> all = bitsOf(*m_bar);
        for (int k = 0; k < splits().size(); ++k)
        {
            const btFemSplit& split = splits()[k];
            all.insert(all.end(), {btScalar(split.m_faces), split.m_area, split.m_stress, split.m_place.x(),
                                   split.m_normal.x(), btScalar(split.m_parts), split.m_time});
            for (int node : split.m_copyOf) all.push_back(btScalar(node));
        }
        return all;
    }

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
