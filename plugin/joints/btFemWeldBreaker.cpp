// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/joints/btFemWeldBreaker.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemVectors.h"

using namespace bullet_fem;

void btFemWeldBreaker::breakWelds(const std::vector<FemSoftBody*>& bodies, double step)
{
    for (FemSoftBody* fem : bodies)
    {
        m_broken.clear();
        m_loads.breakWelds(*fem, step, m_broken);
        for (const WeldBreak& broken : m_broken)
        {
            tell(*fem, broken);
            const auto isOther = [&](const FemSoftBody* b) { return b->m_softBody == broken.m_other; };
            const auto other = std::find_if(bodies.begin(), bodies.end(), isOther);
            for (FemSoftBody* part : {fem, other != bodies.end() ? *other : fem})
            {
                part->m_memory.m_place.forget();  // parted surfaces have contact again
                part->m_softBody->activate();
            }
        }
    }
}

void btFemWeldBreaker::tell(const FemSoftBody& fem, const WeldBreak& broken)
{
    btFemWeldBreak event;
    event.m_weld = broken.m_weld;
    event.m_a = fem.m_softBody;
    event.m_b = broken.m_other;
    event.m_broken = broken.m_broken;
    event.m_left = broken.m_load.m_nodes;
    event.m_force = bulletVector(broken.m_load.m_force);
    event.m_stress = static_cast<btScalar>(broken.m_load.m_stress);
    event.m_stretch = static_cast<btScalar>(broken.m_load.m_stretch);
    event.m_time = static_cast<btScalar>(m_time);
    m_breaks.push_back(event);
}

void btFemWeldBreaker::makeRoom(int nodes)
{
    m_max += nodes;
    m_breaks.reserve(m_max);
    m_broken.reserve(m_max);
}
