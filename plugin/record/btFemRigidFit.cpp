// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/record/btFemRigidFit.h"

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemVectors.h"
#include "fem/common/rotation.h"

using namespace bullet_fem;

btFemRigidFit::btFemRigidFit(const FemSoftBody& fem) : m_X(fem.m_body.m_model->mesh().restPositions())
{
    const std::vector<double>& mass = fem.m_body.m_state.m_mass;
    const auto x = [&fem](std::size_t i) { return vec3(fem.m_softBody->m_nodes[static_cast<int>(i)].m_x); };
    double sum = 0;
    for (std::size_t i = 0; i < m_X.size(); ++i)
    {
        sum += mass[i];
        m_center += mass[i] * x(i);
        m_restCenter += mass[i] * m_X[i];
    }
    m_center *= 1 / sum;
    m_restCenter *= 1 / sum;
    Mat3 spread;
    for (std::size_t i = 0; i < m_X.size(); ++i)
    {
        const Vec3 now = x(i) - m_center, rest = mass[i] * (m_X[i] - m_restCenter);
        spread += Mat3::fromColumns(rest.x * now, rest.y * now, rest.z * now);
    }
    m_rotation = polarRotation(spread, fem.m_body.m_state.m_bodyRotation);
}

btVector3 btFemRigidFit::place(int node) const
{
    return bulletVector(m_center + m_rotation * (m_X[node] - m_restCenter));
}
