// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/impact_stress.h"

#include <algorithm>

#include "bullet_fem/fem/step/stress.h"

namespace bullet_fem
{

double ImpactStresses::impedanceOf(const ImpactScene& scene, int body)
{
    double& impedance = m_impedances[body];
    if (impedance == 0) impedance = waveImpedance(scene.m_bodies[body]->m_body);
    return impedance;
}

void ImpactStresses::find(const ImpactScene& scene, double least)
{
    m_stresses.assign(scene.m_bodies.size(), 0);
    m_impedances.assign(scene.m_bodies.size(), 0);
    for (const ContactPoint& c : scene.m_problem.m_contacts)
    {
        if (!(dot(c.m_impulse, c.m_normal) > 0) || !scene.isPair(c)) continue;
        const double speed = scene.approachOf(c);
        if (!(speed > least)) continue;
        const int body = c.m_soft.m_body, other = c.m_other.m_body;
        const double own = impedanceOf(scene, body);
        if (other < 0)
        {
            m_stresses[body] = std::max(m_stresses[body], speed * own);
            continue;
        }
        const double its = impedanceOf(scene, other), stress = speed * own * its / (own + its);
        for (const int side : {body, other}) m_stresses[side] = std::max(m_stresses[side], stress);
    }
}

}  // namespace bullet_fem
