// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/rest_positions.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "fem/common/rotation.h"

namespace bullet_fem
{
namespace
{

constexpr double kSingle = 1.2e-7;    // relative precision of single precision
constexpr double kSameVolume = 1e-2;  // largest relative difference between an element's volume and that of its matrix
constexpr double kClosed = 1e-3;      // largest distance between two positions of a node by different paths, over an
                                      // element's longest edge

Mat3 edgesOf(const std::vector<Vec3>& x, const Tet& tet)
{
    return Mat3::fromColumns(x[tet[1]] - x[tet[0]], x[tet[2]] - x[tet[0]], x[tet[3]] - x[tet[0]]);
}

bool isFinite(const Mat3& m)
{
    return bullet_fem::isFinite(m.column(0)) && bullet_fem::isFinite(m.column(1)) && bullet_fem::isFinite(m.column(2));
}

Mat3 matrixOf(const btSoftBody::Tetra& tetra)
{
    Mat3 m;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) m(r, c) = tetra.m_Dm_inverse[r][c];
    return m;
}

/// D_m of each element; empty if one is unusable.
std::vector<Mat3> restEdges(const btSoftBody& body)
{
    std::vector<Mat3> Dm(body.m_tetras.size());
    for (int e = 0; e < body.m_tetras.size(); ++e)
    {
        const Mat3 inverted = matrixOf(body.m_tetras[e]);
        const double det = determinant(inverted), measure = body.m_tetras[e].m_element_measure;
        const bool regular = std::isfinite(det) && det != 0 && std::fabs(6 * measure * det - 1) < kSameVolume;
        if (regular) Dm[e] = inverse(inverted);
        if (!regular || !isFinite(Dm[e])) return {};
    }
    return Dm;
}

/// True if F = D_s D_m^-1 is a rotation up to the rounding of x and D_m.
bool isRigid(const Mat3& Ds, const Mat3& Dm, double farthest)
{
    const Mat3 inverted = inverse(Dm), F = Ds * inverted;
    const double size = std::sqrt(squaredNorm(inverted));
    const double rounding = 4 * kSingle * (1 + size * (std::sqrt(squaredNorm(Ds)) + farthest));
    return determinant(F) > 0 && squaredNorm(transposeTimes(F, F) - Mat3::identity()) <= rounding * rounding;
}

/// Breadth-first traversal of elements over common nodes, which reconstructs rest positions.
class Walk
{
public:
    Walk(const std::vector<Tet>& tets, const std::vector<Mat3>& Dm, int nodeCount)
        : m_tets(tets), m_Dm(Dm), m_first(nodeCount + 1, 0), m_X(nodeCount), m_component(nodeCount, -1)
    {
        for (const Tet& tet : tets)
            for (int i : tet) ++m_first[i + 1];
        for (int i = 0; i < nodeCount; ++i) m_first[i + 1] += m_first[i];
        m_around.resize(4 * tets.size());
        std::vector<int> next(m_first.begin(), m_first.end() - 1);
        for (std::size_t e = 0; e < tets.size(); ++e)
            for (int i : tets[e]) m_around[next[i]++] = static_cast<int>(e);
    }

    /// Places the nodes of all connected components, each from its first element. False if two paths to a node
    /// disagree.
    bool placeAll()
    {
        for (std::size_t e = 0; e < m_tets.size(); ++e)
        {
            if (m_component[m_tets[e][0]] >= 0) continue;
            place(m_tets[e][0], {});
            for (; m_next < m_reached.size(); ++m_next)
            {
                const int i = m_reached[m_next];
                for (int k = m_first[i]; k < m_first[i + 1]; ++k)
                    if (!enter(m_around[k], i)) return false;
            }
            ++m_components;
        }
        return true;
    }

    int components() const { return m_components; }
    int component(int node) const
    {
        return m_component[node];
    }  ///< connected component of a node; -1: no element uses it
    std::vector<Vec3>& positions() { return m_X; }

private:
    void place(int node, const Vec3& X)
    {
        m_X[node] = X;
        m_component[node] = m_components;
        m_reached.push_back(node);
    }

    // Places the other nodes of an element relative to a placed one. False if a placed node disagrees.
    bool enter(int e, int node)
    {
        const Mat3& Dm = m_Dm[e];
        const auto corner = [&Dm](int a) { return a == 0 ? Vec3() : Dm.column(a - 1); };
        const int at = static_cast<int>(std::find(m_tets[e].begin(), m_tets[e].end(), node) - m_tets[e].begin());
        const double longest = std::max({norm(corner(1)), norm(corner(2)), norm(corner(3)), norm(corner(2) - corner(1)),
                                         norm(corner(3) - corner(1)), norm(corner(3) - corner(2))});
        for (int a = 0; a < 4; ++a)
        {
            const Vec3 X = m_X[node] + corner(a) - corner(at);
            const int i = m_tets[e][a];
            if (m_component[i] < 0)
                place(i, X);
            else if (!(norm(X - m_X[i]) <= kClosed * longest))
                return false;
        }
        return true;
    }

    const std::vector<Tet>& m_tets;
    const std::vector<Mat3>& m_Dm;
    std::vector<int> m_first, m_around;  // elements around each node
    std::vector<Vec3> m_X;
    std::vector<int> m_component;
    std::vector<int> m_reached;  // in breadth-first order, which limits the accumulation of rounding errors
    std::size_t m_next = 0;
    int m_components = 0;
};

/// Aligns each connected component of the rest shape with its present position: by the rotation nearest to the mean
/// deformation gradient, and by the centres of volume.
void layOverPresent(Walk& walk, const std::vector<Vec3>& x, const std::vector<Tet>& tets, const std::vector<Mat3>& Dm)
{
    struct Component
    {
        Mat3 m_F;
        double m_volume = 0;
        Vec3 m_rest, m_present;  // centres times the volume
    };
    std::vector<Component> components(walk.components());
    std::vector<Vec3>& X = walk.positions();
    for (std::size_t e = 0; e < tets.size(); ++e)
    {
        Component& component = components[walk.component(tets[e][0])];
        const double V = std::fabs(determinant(Dm[e])) / 6;
        component.m_F += V * (edgesOf(x, tets[e]) * inverse(Dm[e]));
        component.m_volume += V;
        for (int i : tets[e])
        {
            component.m_rest += V / 4 * X[i];
            component.m_present += V / 4 * x[i];
        }
    }
    for (Component& component : components)
        component.m_F = polarRotation(1 / component.m_volume * component.m_F, Mat3::identity());
    for (std::size_t i = 0; i < X.size(); ++i)
    {
        if (walk.component(static_cast<int>(i)) < 0)
        {
            X[i] = x[i];
            continue;
        }
        const Component& component = components[walk.component(static_cast<int>(i))];
        const double perVolume = 1 / component.m_volume;
        X[i] = component.m_F * (X[i] - perVolume * component.m_rest) + perVolume * component.m_present;
    }
}

}  // namespace

std::vector<Tet> tetsOf(const btSoftBody& body)
{
    const auto first = reinterpret_cast<std::uintptr_t>(body.m_nodes.size() > 0 ? &body.m_nodes[0] : nullptr);
    const std::uintptr_t end = first + body.m_nodes.size() * sizeof(btSoftBody::Node);
    std::vector<Tet> tets(body.m_tetras.size());
    for (int e = 0; e < body.m_tetras.size(); ++e)
        for (int a = 0; a < 4; ++a)
        {
            const auto node = reinterpret_cast<std::uintptr_t>(body.m_tetras[e].m_n[a]);
            if (node < first || node >= end || (node - first) % sizeof(btSoftBody::Node) != 0)
                throw std::invalid_argument("element " + std::to_string(e) +
                                            " points to a node that is not the body's; append all nodes before the "
                                            "tetrahedra, because appendNode moves the nodes away from under them");
            tets[e][a] = static_cast<int>((node - first) / sizeof(btSoftBody::Node));
        }
    return tets;
}

bool hasElements(const btSoftBody& body, std::size_t nodes, const std::vector<Tet>& tets)
{
    return static_cast<std::size_t>(body.m_nodes.size()) == nodes && tetsOf(body) == tets;
}

RestPositions restPositionsOf(const btSoftBody& body, const std::vector<Tet>& tets)
{
    RestPositions rest;
    if (body.m_nodes.size() == 0) return rest;
    const int n = body.m_nodes.size();
    rest.m_origin = vec3(body.m_nodes[0].m_x);
    rest.m_X.resize(n);
    double farthest = 0;
    bool finite = true;
    for (int i = 0; i < n; ++i)
    {
        const Vec3 x = vec3(body.m_nodes[i].m_x);
        rest.m_X[i] = x - rest.m_origin;
        farthest = std::max(farthest, norm(x));
        finite = finite && bullet_fem::isFinite(x);
    }
    const std::vector<Mat3> Dm = restEdges(body);
    if (!finite || Dm.empty()) return rest;
    Walk walk(tets, Dm, n);
    rest.m_fromMatrices = walk.placeAll();
    if (!rest.m_fromMatrices) return rest;
    bool rigid = true;
    for (std::size_t e = 0; e < tets.size() && rigid; ++e) rigid = isRigid(edgesOf(rest.m_X, tets[e]), Dm[e], farthest);
    if (rigid) return rest;

    layOverPresent(walk, rest.m_X, tets, Dm);
    rest.m_origin += walk.positions()[0];
    for (int i = 0; i < n; ++i) rest.m_X[i] = walk.positions()[i] - walk.positions()[0];
    return rest;
}

}  // namespace bullet_fem
