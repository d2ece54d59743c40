// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "bridge/bridge_test_bodies.h"
#include "bullet_bridge/contact/soft/soft_pair_finder.h"

namespace bullet_fem
{

/// A rotation about all three axes.
inline Mat3 testRotation(double a, double b, double c)
{
    const Mat3 x = {{{1, 0, 0}, {0, std::cos(a), -std::sin(a)}, {0, std::sin(a), std::cos(a)}}};
    const Mat3 y = {{{std::cos(b), 0, std::sin(b)}, {0, 1, 0}, {-std::sin(b), 0, std::cos(b)}}};
    const Mat3 z = {{{std::cos(c), -std::sin(c), 0}, {std::sin(c), std::cos(c), 0}, {0, 0, 1}}};
    return x * y * z;
}

constexpr double kExact = 1e-12;  ///< of lengths about 1 m in double [m]

/// The unit cube.
inline TetMesh cube(int cells = 2)
{
    return makeBox({1, 1, 1}, {cells, cells, cells});
}

/// A tetrahedron whose first node points down to (0.3, 0.41, 0).
inline TetMesh uprightTip()
{
    return TetMesh({{0.3, 0.41, 0}, {0.2, 0.3, 0.5}, {0.4, 0.3, 0.5}, {0.3, 0.6, 0.5}}, {{0, 1, 2, 3}});
}

/// A copy of the mesh without the elements whose centroid satisfies `isOut`, and without nodes used only by them.
template <class Predicate>
TetMesh without(const TetMesh& mesh, Predicate isOut)
{
    std::vector<Vec3> X;
    std::vector<Tet> tets;
    std::vector<int> index(mesh.restPositions().size(), -1);
    for (Tet t : mesh.tets())
    {
        Vec3 middle;
        for (int i : t) middle += 0.25 * mesh.restPositions()[i];
        if (isOut(middle)) continue;
        for (int& i : t)
        {
            if (index[i] < 0)
            {
                index[i] = static_cast<int>(X.size());
                X.push_back(mesh.restPositions()[i]);
            }
            i = index[i];
        }
        tets.push_back(t);
    }
    return TetMesh(std::move(X), std::move(tets));
}

/// A FEM body of any mesh, outside any world, with freely set surface positions.
class PairBody
{
public:
    explicit PairBody(const TetMesh& mesh) : m_soft(makeSoftBody(m_info, mesh)), m_fem(makeFemSoftBody(*m_soft))
    {
        m_x = mesh.restPositions();
        m_v.resize(m_x.size());
        m_fem.m_surface.setRestNeighbours(std::make_shared<const RestNeighbours>(mesh));
    }

    PairBody& move(const Vec3& by)
    {
        for (Vec3& x : m_x) x += by;
        return *this;
    }
    PairBody& turn(const Mat3& R)
    {
        for (Vec3& x : m_x) x = R * x;
        for (Vec3& v : m_v) v = R * v;
        return *this;
    }
    PairBody& throwAt(const Vec3& v)
    {
        m_v.assign(m_v.size(), v);
        return *this;
    }
    template <class Map>
    PairBody& bend(Map map)
    {
        for (Vec3& x : m_x) x = map(x);
        return *this;
    }

    FemSoftBody& ready()
    {
        m_fem.m_surface.place(m_x, m_v, 1.0 / 60);
        m_fem.m_surface.prepareAll();
        return m_fem;
    }

    std::vector<Vec3> m_x, m_v;

private:
    btSoftBodyWorldInfo m_info;

public:
    std::unique_ptr<btSoftBody> m_soft;
    FemSoftBody m_fem;
};

/// The contacts between two bodies, or within one.
struct PairContacts
{
    PairContacts(PairBody& a, PairBody& b, int most = 100000)
    {
        a.ready();
        b.ready();
        const SoftPairSide first = {a.m_fem, 0}, second = {b.m_fem, &a == &b ? 0 : 1};
        m_report = m_finder.find(first, second, most, m_contacts, m_origins);
    }

    int count(SoftPairKind kind) const
    {
        return static_cast<int>(std::count_if(m_origins.begin(), m_origins.end(),
                                              [&](const SoftPairOrigin& o) { return o.m_kind == kind; }));
    }

    /// The contacts as if solved.
    SoftPairMemory::Contacts solved() const { return {m_contacts.data(), m_origins.data(), m_contacts.size()}; }

    SoftPairMemory m_memory;
    SoftPairFinder m_finder{m_memory};
    SoftPairReport m_report;
    std::vector<ContactPoint> m_contacts;
    std::vector<SoftPairOrigin> m_origins;
};

/// Expects normals along z, signed from the lower body (1) to the upper one (0), and gaps of `gap`.
inline void expectAlongZ(const PairContacts& found, double gap)
{
    for (const ContactPoint& c : found.m_contacts)
    {
        EXPECT_NEAR(c.m_normal.z, c.m_soft.m_body == 0 ? 1 : -1, kExact);
        EXPECT_NEAR(c.m_gap, gap, kExact);
    }
}

}  // namespace bullet_fem
