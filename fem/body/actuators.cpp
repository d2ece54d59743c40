// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/body/actuators.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "fem/body/actuator_limits.h"
#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

constexpr double kMaxGas = 1e12;                                                     // [J]
constexpr double kMaxTension = 1e9, kMaxStiffness = 1e12, kLongestRestLength = 1e6;  // [N], [N/m], [m]
constexpr double kMinStrain = -0.9, kMaxStrain = 9;
constexpr double kCableWeightTolerance = 1e-4;  // on the sum of the weights

void checkNumber(double value, double least, double most, const char* name, const char* unitAndRemedy)
{
    if (!(value >= least && value <= most))
        reject(name, " is ", value, ", not in [", least, ", ", most, "] ", unitAndRemedy);
}

void checkActuatorNode(const TetMesh& mesh, int node, const char* of)
{
    if (node < 0 || node >= mesh.nodeCount())
        reject("node ", node, " of the ", of, " is not in [0, ", mesh.nodeCount(), "); give nodes of this body");
}

void checkComponent(const TetMesh& mesh, int node, int first, const char* of)
{
    if (mesh.nodeComponent()[node] != mesh.nodeComponent()[first])
        reject("the ", of, " has nodes ", first, " and ", node,
               " in different components of the body; give it one component, or connect the mesh");
}

void checkElements(const TetMesh& mesh, const std::vector<int>& elements, const char* of)
{
    for (const int e : elements)
        if (e < 0 || e >= mesh.tetCount())
            reject("element ", e, " of the ", of, " is not in [0, ", mesh.tetCount(), "); give elements of this body");
}

using Edge = std::pair<int, int>;

// Every edge is traversed once in each direction, or equally often where several sheets meet.
void checkClosed(const std::vector<Triangle>& triangles)
{
    std::map<Edge, int> times;
    for (const Triangle& t : triangles)
        for (int a = 0; a < 3; ++a) ++times[{t[a], t[(a + 1) % 3]}];
    for (const auto& [edge, count] : times)
    {
        const auto back = times.find({edge.second, edge.first});
        const int backCount = back == times.end() ? 0 : back->second;
        if (count == backCount) continue;
        if ((count + backCount) % 2 == 0)
            reject("two triangles of the chamber run the same way along the edge from node ", edge.first, " to ",
                   edge.second, "; turn one, so that all are counter-clockwise seen from outside the gas");
        reject("the chamber is not closed: the edge from node ", edge.first, " to ", edge.second, " has ",
               count + backCount, " triangle", count + backCount == 1 ? "" : "s", "; give all that bound the gas");
    }
}

// Root of a disjoint set, with path halving.
int rootOf(std::vector<int>& parent, int t)
{
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
}

double signedVolume(const std::vector<Triangle>& triangles, const std::vector<Vec3>& x)
{
    if (triangles.empty()) return 0;
    const Vec3 origin = x[triangles[0][0]];  // nearby origin limits rounding errors
    double sum = 0;
    for (const Triangle& t : triangles) sum += dot(x[t[0]] - origin, cross(x[t[1]] - origin, x[t[2]] - origin));
    return sum / 6;
}

}  // namespace

void Chamber::validate(const TetMesh& mesh) const
{
    checkNumber(m_outsidePressure, 0, kMaxPressure, "the chamber's outside pressure",
                "Pa; 101325 is the standard atmosphere");
    checkNumber(m_pressure, -m_outsidePressure, kMaxPressure, "the chamber's pressure",
                "Pa above the outside pressure; the lower end is a vacuum");
    checkNumber(m_gas, 0, kMaxGas, "the chamber's gas", "J; give absolute pressure times volume");
    if (m_triangles.empty()) reject("the chamber has 0 triangles; give at least 4, a closed surface");
    for (const Triangle& t : m_triangles)
        for (const int node : t)
        {
            checkActuatorNode(mesh, node, "chamber");
            checkComponent(mesh, node, m_triangles[0][0], "chamber");
        }
    checkClosed(m_triangles);
}

void Chamber::validateVolume(const std::vector<Vec3>& x) const
{
    const double now = volume(x);
    if (!(now > 0))
        reject("the chamber's volume is ", now,
               " m3, not in (0, inf); list the nodes of every triangle in the opposite order");
}

double Chamber::volume(const std::vector<Vec3>& x) const
{
    return signedVolume(m_triangles, x);
}

double Chamber::pressureAt(double volume) const
{
    if (!m_isSealed) return m_pressure;
    return (m_gas < kMaxPressure * volume ? m_gas / volume : (m_gas > 0 ? kMaxPressure : 0.0)) - m_outsidePressure;
}

Vec3 CablePoint::at(const std::vector<Vec3>& u) const
{
    Vec3 sum;
    for (int a = 0; a < 4; ++a)
        if (m_weights[a] != 0) sum += m_weights[a] * u[m_nodes[a]];
    return sum;
}

void Cable::validate(const TetMesh& mesh) const
{
    checkNumber(m_tension, 0, kMaxTension, "the cable's tension", "N; a cable pulls only");
    checkNumber(m_stiffness, 0, kMaxStiffness, "the cable's stiffness", "N/m; 0 is a cable of given tension");
    checkNumber(m_restLength, 0, kLongestRestLength, "the cable's rest length", "m");
    if (m_points.size() < 2) reject("the cable has ", m_points.size(), " points; give at least 2");
    const int first = m_points[0].m_nodes[0];
    for (const CablePoint& point : m_points)
    {
        double sum = 0;
        for (int a = 0; a < 4; ++a)
        {
            sum += point.m_weights[a];
            if (point.m_weights[a] == 0) continue;
            checkActuatorNode(mesh, point.m_nodes[a], "cable");
            checkActuatorNode(mesh, first, "cable");
            checkComponent(mesh, point.m_nodes[a], first, "cable");
        }
        if (!(std::fabs(sum - 1) <= kCableWeightTolerance))
            reject("the weights of a point of the cable have the sum ", sum, ", not 1; give barycentric weights");
    }
}

double Cable::length(const std::vector<Vec3>& x) const
{
    double sum = 0;
    for (std::size_t k = 1; k < m_points.size(); ++k) sum += norm(m_points[k].at(x) - m_points[k - 1].at(x));
    return sum;
}

double Cable::tensionAt(double length) const
{
    return m_stiffness > 0 ? std::max(0.0, m_stiffness * (length - m_restLength)) : m_tension;
}

void Fibres::validate(const TetMesh& mesh) const
{
    checkNumber(m_activation, -kMaxActivation, kMaxActivation, "the fibres' activation",
                "Pa; a tenth of Young's modulus is a strong muscle");
    checkElements(mesh, m_elements, "fibres");
    const std::size_t elements = m_elements.empty() ? mesh.tets().size() : m_elements.size();
    if (m_directions.size() != 1 && m_directions.size() != elements)
        reject("the fibres have ", m_directions.size(), " directions for ", elements,
               " elements; give one for all, or one each");
    for (const Vec3& f : m_directions)
        if (!(norm(f) > 0) || !std::isfinite(norm(f)))
            reject("a fibre's direction is (", f.x, ", ", f.y, ", ", f.z, "), of a length not in (0, inf)");
}

void Expansion::validate(const TetMesh& mesh) const
{
    checkNumber(m_strain, kMinStrain, kMaxStrain, "the expansion's strain",
                "; of heat it is the coefficient of expansion times the difference of temperature");
    checkElements(mesh, m_elements, "expansion");
}

void Actuators::validate(const TetMesh& mesh) const
{
    for (const Chamber& chamber : m_chambers) chamber.validate(mesh);
    for (const Cable& cable : m_cables) cable.validate(mesh);
    for (const Fibres& fibres : m_fibres) fibres.validate(mesh);
    for (const Expansion& expansion : m_expansions) expansion.validate(mesh);
}

std::vector<std::vector<Triangle>> findCavities(const TetMesh& mesh)
{
    const std::vector<Triangle>& surface = mesh.surface();
    std::vector<int> parent(surface.size());
    std::iota(parent.begin(), parent.end(), 0);
    std::map<Edge, int> firstAt;
    for (int t = 0; t < static_cast<int>(surface.size()); ++t)
        for (int a = 0; a < 3; ++a)
        {
            const Edge edge = std::minmax(surface[t][a], surface[t][(a + 1) % 3]);
            const int other = rootOf(parent, firstAt.emplace(edge, t).first->second), own = rootOf(parent, t);
            parent[std::max(own, other)] = std::min(own, other);
        }
    std::map<int, std::vector<Triangle>> parts;  // reversed, as the mesh's triangles face the gas
    for (int t = 0; t < static_cast<int>(surface.size()); ++t)
        parts[rootOf(parent, t)].push_back({surface[t][0], surface[t][2], surface[t][1]});
    std::vector<std::vector<Triangle>> cavities;
    for (auto& part : parts)
        if (signedVolume(part.second, mesh.restPositions()) > 0) cavities.push_back(std::move(part.second));
    return cavities;
}

}  // namespace bullet_fem
