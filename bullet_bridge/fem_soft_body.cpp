// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/fem_soft_body.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body_mark.h"
#include "bullet_bridge/bullet_vectors.h"
#include "bullet_fem/fem/stepping.h"

namespace bullet_fem
{

FemSoftBody::FemSoftBody(btSoftBody& softBody, std::shared_ptr<const BodyModel> model,
                         std::shared_ptr<ComplianceCache> compliance, std::shared_ptr<const RestNeighbours> neighbours)
    : m_softBody(&softBody),
      m_mark(markBody(softBody)),
      m_body(std::move(model)),
      m_compliance(std::move(compliance)),
      m_surface(m_body.m_model->mesh(), std::move(neighbours))
{
    const int n = softBody.m_nodes.size();
    m_restOrigin = vec3(softBody.m_nodes[0].m_x);
    m_pins.m_velocity.resize(n);
    m_pins.m_position.resize(n);
    m_pins.m_hasTarget.assign(n, 0);
    m_pins.m_moved.assign(n, 0);
    m_nodeGap.resize(n);
    m_nodeNormal.resize(n);
    m_edgeGap.resize(m_surface.features().m_edges.size());
    for (int i = 0; i < n; ++i)
    {
        btSoftBody::Node& node = softBody.m_nodes[i];
        if (!isFinite(vec3(node.m_v))) node.m_v.setZero();
        m_body.m_state.m_x[i] = vec3(node.m_x);
        m_body.m_state.m_v[i] = vec3(node.m_v);
        m_written.m_x.push_back(node.m_x);
        m_written.m_v.push_back(node.m_v);
        // Masses that were not usable were given their share of the volume.
        if (!(node.m_im >= 0) || !std::isfinite(node.m_im) || (node.m_im > 0 && !std::isfinite(1 / node.m_im)))
            node.m_im = static_cast<btScalar>(1 / m_body.m_state.m_mass[i]);
        m_written.m_inverseMass.push_back(node.m_im);
        if (node.m_im == 0) m_pins.m_velocity[i] = m_body.m_state.m_v[i];
    }
}

double fastestNode(const Body& body, const Vec3& relativeTo)
{
    const std::vector<Vec3>& v = velocity(body);
    double fastest = 0;
    for (int i : body.m_model->mesh().surfaceNodes()) fastest = std::max(fastest, norm(v[i] - relativeTo));
    return fastest;
}

Vec3 FemSoftBody::gravity() const
{
    if (m_hasOwnGravity) return m_ownGravity;
    return m_softBody->m_worldInfo ? vec3(m_softBody->m_worldInfo->m_gravity) : Vec3();
}

}  // namespace bullet_fem
