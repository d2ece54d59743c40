// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/btFemWelds.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// A box cut into fragments: by planes across x, or into Voronoi cells.
struct CutBox
{
    Vec3 m_size = {2, 0.5, 0.5};             ///< [m]
    std::array<int, 3> m_cells = {8, 2, 2};  ///< along every axis
    Vec3 m_center;                           ///< [m]
    int m_slices = 2;                        ///< across x; 0: Voronoi cells
    int m_voronoi = 0;                       ///< so many
    btScalar m_youngModulus = btScalar(1e6);
    btScalar m_poissonRatio = 0;
    btScalar m_massDamping = 0;    ///< [1/s]
    bool m_isClampedLeft = false;  ///< at its lower end of x
};

inline std::vector<int> sliceLabels(const TetMesh& mesh, int slices)
{
    double low = 1e30, high = -1e30;
    for (const Vec3& X : mesh.restPositions()) low = std::min(low, X.x), high = std::max(high, X.x);
    std::vector<int> labels;
    for (const Tet& tet : mesh.tets())
    {
        double x = 0;
        for (int node : tet) x += mesh.restPositions()[node].x / 4;
        labels.push_back(static_cast<int>(slices * (x - low) / (high - low)));
    }
    return labels;
}

/// The fragments in a world, as FEM bodies ready for welding, and the original body, which is in no world.
class CutBoxScene
{
public:
    CutBoxScene(const CutBox& box, Coupling coupling = Coupling::swap, double gravity = 0,
                const btFemSolverInfo& info = implicitEuler(), WorldClass worldClass = WorldClass::softRigid)
        : m_world(worldClass, coupling, {0, 0, btScalar(-gravity)}, info)
    {
        addBox(box);
    }

    void addBox(const CutBox& box)
    {
        const TetMesh mesh = makeBox(box.m_size, box.m_cells, box.m_center - 0.5 * box.m_size);
        m_whole.reset(btFemHelpers::createFromTetMesh(m_world.info(), mesh));
        const double left = box.m_center.x - 0.5 * box.m_size.x;
        for (int i = 0; box.m_isClampedLeft && i < m_whole->m_nodes.size(); ++i)
            if (double(m_whole->m_nodes[i].m_x.x()) < left + 1e-4) m_whole->setMass(i, 0);
        std::vector<int> labels;
        if (box.m_slices > 0)
            labels = sliceLabels(mesh, box.m_slices);
        else
            btFemPieces::voronoiLabels(m_whole.get(), box.m_voronoi, 1, labels);
        btFemPieces::cut(m_whole.get(), labels, m_pieces);
        m_material.m_youngModulus = box.m_youngModulus;
        m_material.m_poissonRatio = box.m_poissonRatio;
        m_material.m_massDamping = box.m_massDamping;
        m_material.m_bending = btFemBending::plain;  // patches of accurate bending end at welds
        for (const btFemPiece& piece : m_pieces)
        {
            m_world.addSoft(piece.m_body);
            m_fem.setMaterial(piece.m_body, m_material);
            m_fem.prepare(piece.m_body, kStep);
        }
    }

    int weld(const btFemWeldStrength& strength = {}) { return btFemWelds::weldPieces(m_fem, m_pieces, strength); }

    /// Applies a force along x to the face at the upper end of x, in the next step [N].
    void pull(double force)
    {
        double right = -1e30, area = 0;
        for (const Vec3& X : nodesOf(*m_whole)) right = std::max(right, X.x);
        for (const bool adds : {false, true})
            for (const btFemPiece& piece : m_pieces)
                for (int t = 0; t < piece.m_body->m_faces.size(); ++t)
                {
                    const btSoftBody::Face& face = piece.m_body->m_faces[t];
                    double third = 1;
                    std::array<Vec3, 3> X;
                    for (int a = 0; a < 3; ++a)
                    {
                        const auto node = face.m_n[a] - &piece.m_body->m_nodes[0];
                        X[a] = vec3(m_whole->m_nodes[piece.m_nodes[node]].m_x);
                        if (X[a].x < right - 1e-4) third = 0;
                    }
                    third *= norm(cross(X[1] - X[0], X[2] - X[0])) / 6;
                    if (!adds) area += 3 * third;
                    for (int a = 0; adds && a < 3; ++a)
                        face.m_n[a]->m_f += btVector3(btScalar(force * third / area), 0, 0);
                }
    }

    /// Sums over the fragments.
    Motion motion() const
    {
        Motion sum;
        for (const btFemPiece& piece : m_pieces) sum += motionOf(*piece.m_body);
        return sum;
    }
    int contacts() const
    {
        int sum = 0;
        for (const btFemPiece& piece : m_pieces) sum += m_fem.contacts(piece.m_body).size();
        return sum;
    }
    double fastest() const
    {
        double speed = 0;
        for (const btFemPiece& piece : m_pieces) speed = std::max(speed, fastestNode(*piece.m_body));
        return speed;
    }
    std::vector<btFemWeldReport> welds() const
    {
        std::vector<btFemWeldReport> all;
        btAlignedObjectArray<btFemWeldReport> some;
        for (const btFemPiece& piece : m_pieces)
        {
            btFemWelds::welds(m_fem, piece.m_body, some);
            for (int k = 0; k < some.size(); ++k) all.push_back(some[k]);
        }
        return all;
    }
    const btAlignedObjectArray<btFemWeldBreak>& breaks() const { return btFemWelds::breaks(m_fem); }

    /// Bits of the fragments' whole visible state, and the breaks.
    std::vector<btScalar> bits() const
    {
        std::vector<btScalar> all;
        for (const btFemPiece& piece : m_pieces)
        {
            const std::vector<btScalar> some = bitsOf(*piece.m_body);
            all.insert(all.end(), some.begin(), some.end());
        }
        for (int k = 0; k < breaks().size(); ++k)
        {
            const btFemWeldBreak& event = breaks()[k];
            all.insert(all.end(), {btScalar(event.m_weld), btScalar(event.m_broken), btScalar(event.m_left),
                                   event.m_force.x(), event.m_stress, event.m_stretch, event.m_time});
        }
        return all;
    }

    static std::vector<Vec3> nodesOf(const btSoftBody& body)
    {
        std::vector<Vec3> nodes;
        for (int i = 0; i < body.m_nodes.size(); ++i) nodes.push_back(vec3(body.m_nodes[i].m_x));
        return nodes;
    }

    FemWorld m_world;
    btFemSoftBodySolver& m_fem = m_world.fem();
    std::unique_ptr<btSoftBody> m_whole;
    std::vector<btFemPiece> m_pieces;
    btFemMaterial m_material;
};

}  // namespace bullet_fem
