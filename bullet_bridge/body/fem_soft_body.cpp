// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/fem_soft_body.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/body_mark.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

constexpr int kUsualImpacts = 4;  // of a body at once; more allocate memory, once

// Comparing all matrices takes a tenth of a step's time. Bullet zeroes the unused fourth component of a row when it
// sets a matrix, and initializeDmInverse sets all matrices. A value stored there is thus lost when it is called.
constexpr btScalar kSeen = 1;

btScalar& seenMark(btAlignedObjectArray<btSoftBody::Tetra>& tetras)
{
    return tetras[0].m_Dm_inverse[0][3];
}

Triangle sortedCorners(Triangle t)
{
    std::sort(t.begin(), t.end());
    return t;
}

// Heights of the elements above the triangles of the boundary [m].
std::vector<double> heightsOf(const TetMesh& mesh)
{
    const std::vector<Vec3>& X = mesh.restPositions();
    const std::vector<unsigned char> sides = mesh.boundarySides();
    std::vector<std::pair<Triangle, double>> known;
    for (int e = 0; e < mesh.tetCount(); ++e)
        for (int a = 0; a < 4; ++a)
        {
            if (!(sides[e] >> a & 1)) continue;
            const Tet& tet = mesh.tets()[e];
            const Triangle t = {tet[(a + 1) % 4], tet[(a + 2) % 4], tet[(a + 3) % 4]};
            const double area = norm(cross(X[t[1]] - X[t[0]], X[t[2]] - X[t[0]])) / 2;
            known.emplace_back(sortedCorners(t), 3 * mesh.tetVolume(e) / area);
        }
    std::sort(known.begin(), known.end());
    std::vector<double> heights;
    for (const Triangle& t : mesh.surface())
        heights.push_back(std::lower_bound(known.begin(), known.end(), std::make_pair(sortedCorners(t), 0.0))->second);
    return heights;
}

}  // namespace

FemSoftBody::FemSoftBody(btSoftBody& softBody, std::shared_ptr<const BodyModel> model,
                         std::shared_ptr<ComplianceCache> compliance)
    : m_softBody(&softBody),
      m_setUp{markBody(softBody), &softBody.m_nodes[0], TopologyMarks(softBody), vec3(softBody.m_nodes[0].m_x), {}},
      m_body(std::move(model)),
      m_compliance(std::move(compliance)),
      m_surface(boundaryOf(m_body.m_model->mesh()))
{
    const int n = softBody.m_nodes.size();
    m_pins.m_velocity.resize(n);
    m_pins.m_position.resize(n);
    m_pins.m_hasTarget.assign(n, 0);
    m_pins.m_moved.assign(n, 0);
    m_memory.m_predicted.reserve(n);
    sizeScratch();
    noteRestMatrices(*this);
    for (int i = 0; i < n; ++i)
    {
        btSoftBody::Node& node = softBody.m_nodes[i];
        if (!isFinite(vec3(node.m_v))) node.m_v.setZero();
        m_body.m_state.m_x[i] = vec3(node.m_x);
        m_body.m_state.m_v[i] = vec3(node.m_v);
        m_written.m_x.push_back(node.m_x);
        m_written.m_v.push_back(node.m_v);
        // Unusable masses were replaced by shares of the volume.
        if (!(node.m_im >= 0) || !std::isfinite(node.m_im) || (node.m_im > 0 && !std::isfinite(1 / node.m_im)))
            node.m_im = static_cast<btScalar>(1 / m_body.m_state.m_mass[i]);
        m_written.m_inverseMass.push_back(node.m_im);
        if (node.m_im == 0) m_pins.m_velocity[i] = m_body.m_state.m_v[i];
    }
}

void FemSoftBody::sizeScratch()
{
    m_search.m_nodeGap.resize(m_surface.topology().vertexCount());
    m_search.m_nodeNormal.resize(m_surface.topology().vertexCount());
    m_search.m_edgeGap.resize(m_surface.topology().edgeCount());
    m_memory.m_contacts.clear();
    m_memory.m_origins.clear();
    m_memory.m_impacts.clear();
    m_memory.m_impacts.reserve(kUsualImpacts);
    m_memory.m_place = NotedPlace(m_surface.topology().vertices());
    m_ofMesh = {};
    if (m_skin) return;
    const TetMesh& mesh = m_body.m_model->mesh();
    m_ofMesh.m_height = heightsOf(mesh);
    for (int i = 0; i < mesh.nodeCount(); ++i)
        if (m_surface.topology().trianglesAt(i).size() == 0 && !mesh.isLoose(i)) m_ofMesh.m_inner.push_back(i);
}

void FemSoftBody::setSkin(std::shared_ptr<const CollisionSkin> skin, std::shared_ptr<ComplianceCache> compliance)
{
    m_surface = skin ? SoftSurface(skin->rest()) : SoftSurface(boundaryOf(m_body.m_model->mesh()));
    if (skin || m_skin)
    {
        m_memory.m_sheetSides.clear();
        m_memory.m_solids.clear();
        m_memory.m_positions.clear();
    }
    m_skin = std::move(skin);
    m_skinMotion.m_position.resize(m_skin ? m_surface.topology().vertexCount() : 0);
    m_skinMotion.m_velocity.resize(m_skinMotion.m_position.size());
    m_compliance = std::move(compliance);
    sizeScratch();
}

void FemSoftBody::serveInnerNodes()
{
    if (m_compliance == m_ofMesh.m_servesInner) return;
    const TetMesh& mesh = m_body.m_model->mesh();
    std::vector<int> nodes;
    for (int i = 0; i < mesh.nodeCount(); ++i)
        if (!mesh.isLoose(i)) nodes.push_back(i);
    m_compliance = makeComplianceCache(m_body.m_model, std::move(nodes));
    m_ofMesh.m_servesInner = m_compliance;
}

void FemSoftBody::updateSkin()
{
    if (!m_skin || (m_skinMotion.m_isHeld && m_skinMotion.m_isUpdated)) return;
    m_skin->follow(m_body.m_state.m_x, m_skinMotion.m_position);
    m_skin->follow(freeMeanVelocity(m_body), m_skinMotion.m_velocity);
    m_skinMotion.m_isUpdated = true;
}

void FemSoftBody::holdForSearches(bool held)
{
    m_skinMotion.m_isHeld = held;
    m_skinMotion.m_isUpdated = false;
}

const std::vector<Vec3>& FemSoftBody::surfaceVelocity() const
{
    return m_skin ? m_skinMotion.m_velocity : freeMeanVelocity(m_body);
}

bool restMatricesChanged(const FemSoftBody& fem)
{
    btAlignedObjectArray<btSoftBody::Tetra>& tetras = fem.m_softBody->m_tetras;
    if (seenMark(tetras) == kSeen) return false;
    const auto sameBits = [](const btMatrix3x3& a, const btMatrix3x3& b)  // matrices that were never set may be NaN
    {
        for (int r = 0; r < 3; ++r)
            if (std::memcmp(&a[r], &b[r], 3 * sizeof(btScalar)) != 0) return false;
        return true;
    };
    for (int e = 0; e < tetras.size(); ++e)
        if (!sameBits(tetras[e].m_Dm_inverse, fem.m_setUp.m_restMatrices[e])) return true;
    seenMark(tetras) = kSeen;
    return false;
}

void noteRestMatrices(FemSoftBody& fem)
{
    btAlignedObjectArray<btSoftBody::Tetra>& tetras = fem.m_softBody->m_tetras;
    fem.m_setUp.m_restMatrices.clear();
    for (int e = 0; e < tetras.size(); ++e) fem.m_setUp.m_restMatrices.push_back(tetras[e].m_Dm_inverse);
    seenMark(tetras) = kSeen;
}

void changeRestShape(FemSoftBody& fem, std::shared_ptr<const BodyModel> model,
                     std::shared_ptr<ComplianceCache> compliance)
{
    Body body(std::move(model));
    BodyState &now = body.m_state, &before = fem.m_body.m_state;
    now.m_x.swap(before.m_x);
    now.m_v.swap(before.m_v);
    now.m_mass.swap(before.m_mass);
    now.m_fixed.swap(before.m_fixed);
    body.m_actuators = std::move(fem.m_body.m_actuators);
    now.m_initialStress.swap(before.m_initialStress);
    now.m_initialStressChanges = before.m_initialStressChanges;
    // Bullet makes the present shape the rest shape: plastic strain becomes part of it, but hardening remains.
    if (!now.m_plasticStrain.empty() && !before.m_plasticStrain.empty())
        now.m_equivalentPlasticStrain.swap(before.m_equivalentPlasticStrain);
    fem.m_body = std::move(body);
    fem.setSkin(nullptr, std::move(compliance));
}

double fastestNode(const Body& body, const Vec3& relativeTo)
{
    const std::vector<Vec3>& v = freeMeanVelocity(body);
    double fastest = 0;  // squared
    for (int i : body.m_model->mesh().surfaceNodes())
        fastest = std::max(fastest, dot(v[i] - relativeTo, v[i] - relativeTo));
    return std::sqrt(fastest);
}

double fastestVertex(const FemSoftBody& fem, const Vec3& relativeTo)
{
    if (!fem.m_skin) return fastestNode(fem.m_body, relativeTo);
    double fastest = 0;
    for (const Vec3& v : fem.surfaceVelocity()) fastest = std::max(fastest, norm(v - relativeTo));
    return fastest;
}

Vec3 FemSoftBody::gravity() const
{
    if (m_settings.m_ownGravity) return *m_settings.m_ownGravity;
    return m_softBody->m_worldInfo ? vec3(m_softBody->m_worldInfo->m_gravity) : Vec3();
}

}  // namespace bullet_fem
