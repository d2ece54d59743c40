// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Fracture along the faces of elements, node by node, after [Parker & O'Brien 2009]: where the maximum tension at a
// node exceeds the strength, the adjacent elements are divided by a plane across that tension.
#include "bullet_fem/fem/fracture/fracture.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "fem/common/disjoint_sets.h"
#include "fem/elements/model_elements.h"
#include "fem/mesh/element_faces.h"

namespace bullet_fem
{
namespace
{

// Minimum ratio of the projected area of a cut's faces along its normal to their area [-]: with a smaller one the faces
// run along the tension rather than across it. A cut of a regular mesh has 1, a zigzag of regular tetrahedra about .8.
constexpr double kMinAcross = 0.3;

// Share of the strength [-] that an element's tension must exceed for its nodes to be tested: a node at a crack tip
// carries more tension than its elements.
constexpr double kTense = 0.5;

// True if no eigenvalue exceeds the limit: limit I - s has positive pivots.
bool isTensionBelow(const Stress& s, double limit)
{
    const double a = limit - s.xx;
    if (!(a > 0)) return false;
    const double b = limit - s.yy - s.xy * s.xy / a, c = s.yz + s.xy * s.xz / a;
    return b > 0 && limit - s.zz - s.xz * s.xz / a - c * c / b > 0;
}

Vec3 directionOfLargestTension(const Stress& s)
{
    Eigen::Matrix3d S;
    S << s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(S);
    const auto q = eigen.eigenvectors().col(2);
    return {q(0), q(1), q(2)};
}

/// Outward area vector of the side opposite node a [m2].
Vec3 areaOf(const std::vector<Vec3>& x, const Tet& tet, int a)
{
    const Vec3 &p = x[tet[(a + 1) % 4]], &q = x[tet[(a + 2) % 4]], &r = x[tet[(a + 3) % 4]];
    const Vec3 area = 0.5 * cross(q - p, r - p);
    return a % 2 == 0 ? area : -area;
}

Vec3 elementMiddle(const std::vector<Vec3>& x, const Tet& tet)
{
    return 0.25 * (x[tet[0]] + x[tet[1]] + x[tet[2]] + x[tet[3]]);
}

int placeInTet(const Tet& tet, int node)
{
    return static_cast<int>(std::find(tet.begin(), tet.end(), node) - tet.begin());
}

int sideTo(const std::array<int, 4>& neighbours, int element)
{
    return static_cast<int>(std::find(neighbours.begin(), neighbours.end(), element) - neighbours.begin());
}

}  // namespace

Fracture::Fracture(std::shared_ptr<const RestShape> shape)
    : m_shape(std::move(shape)), m_mesh(m_shape->m_mesh), m_neighbour(elementsBehindFaces(m_mesh.tets()))
{
    const TetMesh& mesh = m_mesh;
    m_first.resize(mesh.restPositions().size() + 1);
    for (const Tet& tet : mesh.tets())
        for (int node : tet) ++m_first[node + 1];
    std::partial_sum(m_first.begin(), m_first.end(), m_first.begin());
    std::vector<int> next(m_first.begin(), m_first.end() - 1);
    m_around.resize(4 * mesh.tets().size());
    for (int e = 0; e < mesh.tetCount(); ++e)
        for (int node : mesh.tets()[e]) m_around[next[node]++] = e;
    m_stress.reserve(mesh.tets().size());
    m_begins.reserve(mesh.restPositions().size());
    m_isTense.resize(mesh.restPositions().size());
    m_isAtCut.resize(mesh.restPositions().size());
    m_side.resize(mesh.tets().size());
    m_sideHere.resize(mesh.tets().size());
    m_isCut.resize(mesh.tets().size());
}

bool Fracture::markTense(double strength)
{
    const double least = kTense * strength;
    bool any = false;
    for (std::size_t e = 0; e < m_stress.size(); ++e)
    {
        if (isTensionBelow(m_stress[e], least)) continue;
        if (!any) std::fill(m_isTense.begin(), m_isTense.end(), 0);
        any = true;
        for (int node : m_mesh.tets()[e]) m_isTense[node] = 1;
    }
    return any;
}

// Direction of the maximum tension of the volume-weighted mean stress around a node.
Vec3 Fracture::tensionAt(int node) const
{
    Stress mean;
    for (int k = m_first[node]; k < m_first[node + 1]; ++k)
        mean += m_mesh.tetVolume(m_around[k]) * m_stress[m_around[k]];
    return directionOfLargestTension(mean);
}

int Fracture::sideOf(const Body& body, int element, const Vec3& x, const Vec3& normal) const
{
    if (m_side[element] != 0) return m_side[element];
    return dot(normal, elementMiddle(body.m_state.m_x, m_mesh.tets()[element]) - x) > 0 ? 1 : -1;
}

// Stress across a cut at a node. An element pulls the node with sigma A / 3, A the area vector of the side opposite the
// node. The mean normal force of the two sides' elements, divided by a third of the projected area of the faces between
// them, is n . sigma n in uniform stress, however the faces zigzag, and at a crack tip the stress that the node
// carries.
Fracture::Cut Fracture::cutAt(const Body& body, int node, const Vec3& along)
{
    Cut cut;
    cut.m_normal = tensionAt(node);
    if (dot(cut.m_normal, along) < 0) cut.m_normal = -cut.m_normal;
    const std::vector<Vec3>& x = body.m_state.m_x;
    double force = 0, across = 0, area = 0;
    for (int k = m_first[node]; k < m_first[node + 1]; ++k)
        m_sideHere[m_around[k]] = static_cast<signed char>(sideOf(body, m_around[k], x[node], cut.m_normal));
    for (int k = m_first[node]; k < m_first[node + 1]; ++k)
    {
        const int e = m_around[k], side = m_sideHere[e];
        const Tet& tet = m_mesh.tets()[e];
        force += side * dot(cut.m_normal, toMatrix(m_stress[e]) * areaOf(x, tet, placeInTet(tet, node))) / 6;
        for (int a = 0; side > 0 && a < 4; ++a)
        {
            const int f = m_neighbour[e][a];
            if (f < 0 || tet[a] == node || m_sideHere[f] > 0) continue;
            const Vec3 face = areaOf(x, tet, a);
            across -= dot(cut.m_normal, face) / 3;
            area += norm(face) / 3;
        }
    }
    cut.m_isThere = across > kMinAcross * area;
    if (cut.m_isThere) cut.m_stress = force / across;
    return cut;
}

void Fracture::listBegins(const Body& body, double strength)
{
    m_begins.clear();
    for (int i = 0; i < m_mesh.nodeCount(); ++i)
    {
        if (!m_isTense[i]) continue;
        const Cut cut = cutAt(body, i, {});
        if (cut.m_isThere && cut.m_stress > strength) m_begins.push_back({i, cut.m_stress});
    }
    std::sort(m_begins.begin(), m_begins.end(),
              [](const Begin& a, const Begin& b)
              { return a.m_stress != b.m_stress ? a.m_stress > b.m_stress : a.m_node < b.m_node; });
}

// Assigns all elements around the node to the sides of the crack and cuts the faces between the sides.
void Fracture::open(const Body& body, int node, const Vec3& normal, Crack& crack)
{
    const std::vector<Vec3>& x = body.m_state.m_x;
    for (int k = m_first[node]; k < m_first[node + 1]; ++k)
        m_side[m_around[k]] = static_cast<signed char>(sideOf(body, m_around[k], x[node], normal));
    for (int k = m_first[node]; k < m_first[node + 1]; ++k)
    {
        const int e = m_around[k];
        const Tet& tet = m_mesh.tets()[e];
        for (int a = 0; a < 4; ++a)
        {
            const int f = m_neighbour[e][a];
            if (f < e || tet[a] == node || m_side[e] == m_side[f] || (m_isCut[e] >> a & 1)) continue;
            m_isCut[e] = static_cast<unsigned char>(m_isCut[e] | 1 << a);
            m_isCut[f] = static_cast<unsigned char>(m_isCut[f] | 1 << sideTo(m_neighbour[f], e));
            ++crack.m_faces;
            crack.m_area += norm(areaOf(x, tet, a));
            for (int b = 0; b < 4; ++b)
            {
                if (b == a || m_isAtCut[tet[b]]) continue;
                m_isAtCut[tet[b]] = 1;
                m_front.push_back(tet[b]);
            }
        }
    }
}

// Grows a crack from node to node over cut faces while the strength is exceeded.
Crack Fracture::grow(const Body& body, const Begin& begin, double strength)
{
    Crack crack;
    const Cut first = cutAt(body, begin.m_node, {});
    crack.m_place = body.m_state.m_x[begin.m_node];
    crack.m_normal = first.m_normal;
    crack.m_stress = first.m_stress;
    m_front.assign(1, begin.m_node);
    m_isAtCut[begin.m_node] = 1;
    for (std::size_t k = 0; k < m_front.size(); ++k)
    {
        const Cut cut = cutAt(body, m_front[k], crack.m_normal);
        if (k > 0 && !(cut.m_isThere && cut.m_stress > strength)) continue;
        const int node = m_front[k];
        open(body, node, cut.m_normal, crack);
    }
    return crack;
}

// True near a crack of this step, where the computed stresses are outdated.
bool Fracture::isNearCrack(int node) const
{
    for (int k = m_first[node]; k < m_first[node + 1]; ++k)
        for (int other : m_mesh.tets()[m_around[k]])
            if (m_isAtCut[other]) return true;
    return false;
}

// Elements around a node are connected by uncut faces at it; every connected set but the first gets a copy of the node.
void Fracture::part(int node, SplitMesh& split) const
{
    const int count = m_first[node + 1] - m_first[node];
    DisjointSets sets(count);
    for (int k = 0; k < count; ++k)
    {
        const int e = m_around[m_first[node] + k];
        for (int a = 0; a < 4; ++a)
        {
            const int f = m_neighbour[e][a];
            if (f < 0 || m_mesh.tets()[e][a] == node || (m_isCut[e] >> a & 1)) continue;
            const auto at = std::lower_bound(m_around.begin() + m_first[node], m_around.begin() + m_first[node + 1], f);
            sets.join(k, static_cast<int>(at - m_around.begin()) - m_first[node]);
        }
    }
    for (int k = 1; k < count; ++k)
    {
        if (sets.root(k) != k) continue;
        const int copy = m_mesh.nodeCount() + static_cast<int>(split.m_copyOf.size());
        split.m_copyOf.push_back(node);
        for (int l = k; l < count; ++l)
        {
            const int e = m_around[m_first[node] + l];
            if (sets.root(l) == k) split.m_tets[e][placeInTet(m_mesh.tets()[e], node)] = copy;
        }
    }
}

bool Fracture::find(const Body& body, const FractureLimits& limits, SplitMesh& split)
{
    elementStresses(body, m_stress);
    if (!markTense(limits.m_strength)) return false;
    listBegins(body, limits.m_strength);
    if (m_begins.empty()) return false;
    split.m_tets = m_mesh.tets();
    split.m_copyOf.clear();
    split.m_cracks.clear();
    for (const Begin& begin : m_begins)
    {
        if (static_cast<int>(split.m_cracks.size()) == limits.m_mostCracks) break;
        if (!isNearCrack(begin.m_node)) split.m_cracks.push_back(grow(body, begin, limits.m_strength));
    }
    for (int i = 0; i < m_mesh.nodeCount(); ++i)
        if (m_isAtCut[i]) part(i, split);
    std::fill(m_isAtCut.begin(), m_isAtCut.end(), 0);
    std::fill(m_isCut.begin(), m_isCut.end(), 0);
    std::fill(m_side.begin(), m_side.end(), 0);
    return true;
}

std::vector<double> splitMasses(const TetMesh& mesh, const SplitMesh& split, const std::vector<double>& filled,
                                const std::vector<double>& mass)
{
    const std::size_t before = mesh.restPositions().size(), after = before + split.m_copyOf.size();
    std::vector<double> whole(before, 0.0), share(after, 0.0);
    for (int e = 0; e < mesh.tetCount(); ++e)
        for (int a = 0; a < 4; ++a)
        {
            const double volume = mesh.tetVolume(e) * (filled.empty() ? 1 : filled[e]);
            whole[mesh.tets()[e][a]] += volume;
            share[split.m_tets[e][a]] += volume;
        }
    std::vector<double> masses(mass.begin(), mass.end());
    for (std::size_t k = 0; k < split.m_copyOf.size(); ++k)
    {
        const int node = split.m_copyOf[k];
        masses.push_back(mass[node] * share[before + k] / whole[node]);
        masses[node] -= masses.back();
    }
    return masses;
}

Body splitBody(const Body& body, std::shared_ptr<const BodyModel> model, const std::vector<int>& copyOf)
{
    const BodyModel& before = *body.m_model;
    Body after(std::move(model));
    const BodyState& from = body.m_state;
    BodyState& to = after.m_state;
    const auto carry = [&](const auto& old, auto& now)
    {
        std::copy(old.begin(), old.end(), now.begin());
        for (std::size_t k = 0; k < copyOf.size(); ++k) now[old.size() + k] = old[copyOf[k]];
    };
    carry(from.m_x, to.m_x);
    carry(from.m_v, to.m_v);
    carry(from.m_fixed, to.m_fixed);
    for (int k = 0; k < 2; ++k) carry(from.m_lastIncrement[k], to.m_lastIncrement[k]);
    const ElementLanes &oldLanes = before.elements().m_lanes, &newLanes = after.m_model->elements().m_lanes;
    for (std::size_t lane = 0; lane < newLanes.m_element.size(); ++lane)
        to.m_elementRotation[lane] = from.m_elementRotation[oldLanes.m_lane[newLanes.m_element[lane]]];
    to.m_bodyRotation = from.m_bodyRotation;
    to.m_initialStress = from.m_initialStress;
    to.m_initialStressChanges = from.m_initialStressChanges;
    to.m_plasticStrain = from.m_plasticStrain;
    to.m_equivalentPlasticStrain = from.m_equivalentPlasticStrain;
    to.m_relaxedStrain = from.m_relaxedStrain;
    to.m_leastStep = from.m_leastStep;
    to.m_mostStep = from.m_mostStep;
    // Elements keep their indices; nodes of cables and chambers may have separated.
    after.m_actuators.m_fibres = body.m_actuators.m_fibres;
    after.m_actuators.m_expansions = body.m_actuators.m_expansions;
    after.m_actuators.m_ownStress = body.m_actuators.m_ownStress;
    return after;
}

}  // namespace bullet_fem
