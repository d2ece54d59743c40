// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/solver/contact_sweeps.h"

namespace bullet_fem
{

void ContactSweeps::begin()
{
    m_joints.begin();
    m_inTurn.begin();
    m_atOnce.begin();
    m_runaways.reserve(m_rows.movers());
}

void ContactSweeps::measure()
{
    m_rows.measure();
    reset();
}

RowSurvey ContactSweeps::look()
{
    m_inTurn.noteLooked();
    return m_rows.survey();
}

void ContactSweeps::reset()
{
    m_joints.shift(nullptr);
    m_inTurn.restart();
    m_atOnce.restart();
}

bool ContactSweeps::sweep(double tolerance)
{
    return m_rows.isDense() ? m_inTurn.sweep(tolerance) : m_atOnce.sweep(tolerance);
}

bool ContactSweeps::runsAway() const
{
    return m_rows.isRunaway(m_rows.isDense() ? m_inTurn.lastSpeed() : m_atOnce.lastSpeed());
}

void ContactSweeps::letGo()
{
    m_runaways.assign(m_rows.movers(), 0);
    const auto forMovableEnds = [this](const ContactRow& row, const auto& visit)
    {
        for (const ConstraintSide* end : {&row.m_a, &row.m_b})
            if (const int mover = m_rows.mover(*end); mover >= 0) visit(m_runaways[mover]);
    };
    for (const ContactRow& row : m_rows.rows())
        if (!row.m_joint && m_rows.share(speedOf(row, row.m_impulse)) > 1)
            forMovableEnds(row, [](unsigned char& runs) { runs = 1; });
    for (ContactRow& row : m_rows.rows())
    {
        bool runs = false;
        forMovableEnds(row, [&runs](unsigned char end) { runs = runs || end; });
        if (!runs || row.m_joint) continue;
        m_rows.change(row, {});
        row.m_idle = true;
    }
    m_rows.flush();
    reset();
}

}  // namespace bullet_fem
