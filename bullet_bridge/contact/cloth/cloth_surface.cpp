// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/cloth/cloth_surface.h"

#include <algorithm>
#include <cmath>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/body_arrays.h"
#include "bullet_bridge/geometry/limits.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{

bool isCloth(const btSoftBody& body)
{
    return body.m_tetras.size() == 0 && body.m_nodes.size() > 0;
}

ClothSurface::ClothSurface(btSoftBody& cloth) : m_cloth(&cloth), m_id(broadphaseId(cloth)) {}

// The start position is x - h v of the present node: this holds in all of Bullet's worlds, unlike m_q.
bool ClothSurface::update(double worldStep)
{
    const btSoftBody& cloth = *m_cloth;
    if (!hasUsableNodes(cloth)) return false;
    const double own = cloth.m_sst.sdt;
    m_step = own > 0 && std::isfinite(own) ? own : worldStep;
    const double margin = cloth.getCollisionShape()->getMargin();
    m_thickness = margin > 0 && margin < kFarthest ? margin : 0;
    const auto count = static_cast<std::size_t>(cloth.m_nodes.size());
    for (std::vector<Vec3>* values : {&m_position, &m_change, &m_velocity}) values->resize(count);
    m_inverseMass.resize(count);
    const bool moves = cloth.isActive();
    for (std::size_t i = 0; i < count; ++i)
    {
        const btSoftBody::Node& node = cloth.m_nodes[static_cast<int>(i)];
        const Vec3 v = moves ? vec3(node.m_v) : Vec3();
        if (!isBelow(kFastest, v)) return false;
        m_velocity[i] = v;
        m_change[i] = m_step * v;
        m_position[i] = vec3(node.m_x) - m_change[i];
        const double inverseMass = node.m_im;
        m_inverseMass[i] = moves && inverseMass > 0 && std::isfinite(inverseMass) ? inverseMass : 0;
    }
    readTriangles();
    if (m_tree) m_tree->refit(m_position, m_change);
    return true;
}

// Programs may cut cloth: the tree is rebuilt when the faces' node indices have changed.
void ClothSurface::readTriangles()
{
    const btSoftBody& cloth = *m_cloth;
    const btSoftBody::Node* first = &cloth.m_nodes[0];
    const auto indexOf = [&](const btSoftBody::Node* node) { return static_cast<int>(node - first); };
    const auto isOne = [&](int i) { return i >= 0 && i < nodeCount(); };
    m_triangles.clear();
    const auto add = [&](const Triangle& t)
    {
        if (isOne(t[0]) && isOne(t[1]) && isOne(t[2])) m_triangles.push_back(t);
    };
    for (int f = 0; f < cloth.m_faces.size(); ++f)
    {
        const btSoftBody::Face& face = cloth.m_faces[f];
        add({indexOf(face.m_n[0]), indexOf(face.m_n[1]), indexOf(face.m_n[2])});
    }
    for (int l = 0; cloth.m_faces.size() == 0 && l < cloth.m_links.size(); ++l)
    {
        const btSoftBody::Link& link = cloth.m_links[l];
        if (!link.m_bbending) add({indexOf(link.m_n[0]), indexOf(link.m_n[1]), indexOf(link.m_n[1])});
    }
    const bool asBuilt = m_tree && m_built == m_triangles && m_tree->positions().size() == m_position.size();
    if (asBuilt || m_triangles.empty())
    {
        if (m_triangles.empty()) m_tree.reset();
        return;
    }
    m_built = m_triangles;
    m_tree = std::make_unique<SurfaceTree>(m_position, m_triangles);
}

void ClothSurface::move(int node, const Vec3& impulse, const Vec3& displacement)
{
    const Vec3 dv = m_inverseMass[static_cast<std::size_t>(node)] * impulse;
    const Vec3 dx = m_step * dv + displacement;
    if (!isBelow(kFastest, dv) || !isBelow(kFarthest, dx)) return;
    btSoftBody::Node& n = m_cloth->m_nodes[node];
    n.m_v += bulletVector(dv);
    n.m_x += bulletVector(dx);
}

}  // namespace bullet_fem
