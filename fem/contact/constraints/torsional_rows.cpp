// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Rows of rolling and spinning friction: couples between a patch of nodes or a rigid proxy and a rigid proxy, limited
// by the normal impulses of the contacts between the two. A contact adds every change of its normal impulse to the row
// that it loads, so sweeps apply Coulomb's law with the present load.
#include "fem/contact/constraints/contact_rows.h"

namespace bullet_fem
{

void ContactRows::addTorsionRow(const TorsionalFriction& torsion)
{
    ContactRow row;
    row.m_torsion = true;
    row.m_a.m_body = torsion.m_body;
    if (torsion.m_body >= 0)
        row.m_a.m_end = m_bodies[torsion.m_body].addGroup(m_problem->m_handleNodes.data() + torsion.m_first,
                                                          m_problem->m_handleBlocks.data() + torsion.m_first,
                                                          torsion.m_count, true);
    row.m_a.m_rigidProxy = torsion.m_body >= 0 ? -1 : torsion.m_firstRigidProxy;
    row.m_a.m_angular = torsion.m_body < 0;
    row.m_b.m_rigidProxy = torsion.m_rigidProxy;
    row.m_b.m_angular = true;
    for (int i = 0; i < 3; ++i)
    {
        row.m_axes[i] = torsion.m_axes[i];
        row.m_target[i] = dot(torsion.m_spin, torsion.m_axes[i]);
    }
    row.m_limit = torsion.m_friction;
    row.m_maxLoad = torsion.m_maxLoad;
    row.m_lever = torsion.m_lever;
    m_rows.push_back(row);
}

void ContactRows::pressOnTorsions()
{
    if (m_problem->m_torsions.empty()) return;
    const int first = static_cast<int>(m_rows.size() - m_problem->m_torsions.size());
    const auto pressOn = [&](ContactRow& row, int torsion)
    {
        if (torsion < 0) return;
        row.m_pressed = first + torsion;
        press(row, row.m_impulse);
    };
    for (std::size_t k = 0; k < m_problem->m_torsionOf.size(); ++k) pressOn(m_rows[k], m_problem->m_torsionOf[k]);
    std::size_t k = m_problem->m_contacts.size() + m_problem->m_joints.size();
    for (const RigidContact& contact : m_problem->m_rigidContacts) pressOn(m_rows[k++], contact.m_torsion);
}

}  // namespace bullet_fem
