// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/solver/accelerated_projected_gradient.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{

namespace
{

bool isSwept(const ContactRow& row)
{
    return !row.m_idle && !row.m_joint;
}

}  // namespace

void AcceleratedProjectedGradient::begin()
{
    m_step = 0;
    if (m_rows.isDense()) return;
    m_memory.assign(m_rows.rows().size(), {});
}

void AcceleratedProjectedGradient::restart()
{
    m_acceleration = 1;
    if (m_rows.isDense()) return;
    for (std::size_t k = 0; k < m_memory.size(); ++k)
    {
        const ContactRow& row = m_rows.rows()[k];
        m_memory[k].m_impulse = row.m_impulse;
        m_memory[k].m_velocity = m_rows.velocity(row);
    }
}

// Step size of the gradient: the inverse of the largest eigenvalue of the compliance, scaled by each row's own, by
// power iterations from the present impulses. These resemble its eigenvector, so few iterations suffice. Probes are
// added to the impulses, which are saved in m_next and restored at the end.
void AcceleratedProjectedGradient::chooseStep()
{
    constexpr int kIterations = 8;
    constexpr double kSafety = 1.2, kSettled = 1.05;
    std::vector<ContactRow>& rows = m_rows.rows();
    double eigenvalue = 1;
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
        const ContactRow& row = rows[k];
        const double length = norm(row.m_impulse);
        m_memory[k].m_next = row.m_impulse;
        m_memory[k].m_velocity = m_rows.velocity(row);
        m_memory[k].m_impulse = length > 0 ? (1 / length) * row.m_impulse : row.m_axes[0];
        m_memory[k].m_impulse *= 1 / std::sqrt(std::max(row.m_rowCompliance.x, 1e-300));
    }
    for (int i = 0; i < kIterations; ++i)
    {
        const double sum = sumOfSquares();
        probe(sum > 0 ? 1 / std::sqrt(sum) : 0);
        for (std::size_t k = 0; k < rows.size(); ++k)
            if (isSwept(rows[k]))
                m_memory[k].m_impulse =
                    (1 / rows[k].m_rowCompliance.x) * (m_rows.velocity(rows[k]) - m_memory[k].m_velocity);
        const double before = eigenvalue;
        eigenvalue = std::max(before, std::sqrt(sumOfSquares()));
        if (i > 0 && eigenvalue < kSettled * before) break;
    }
    for (std::size_t k = 0; k < rows.size(); ++k) m_rows.change(rows[k], m_memory[k].m_next);
    m_rows.flush();
    m_step = 1 / (kSafety * eigenvalue);
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
        m_memory[k].m_impulse = rows[k].m_impulse;
        m_memory[k].m_velocity = m_rows.velocity(rows[k]);
    }
}

// Sum of squares of the probes, weighted by the rows' compliance.
double AcceleratedProjectedGradient::sumOfSquares() const
{
    const std::vector<ContactRow>& rows = m_rows.rows();
    double sum = 0;
    for (std::size_t k = 0; k < rows.size(); ++k)
        if (isSwept(rows[k])) sum += rows[k].m_rowCompliance.x * dot(m_memory[k].m_impulse, m_memory[k].m_impulse);
    return sum;
}

void AcceleratedProjectedGradient::probe(double unit)
{
    std::vector<ContactRow>& rows = m_rows.rows();
    for (std::size_t k = 0; k < rows.size(); ++k)
        if (isSwept(rows[k])) m_rows.change(rows[k], m_memory[k].m_next + unit * m_memory[k].m_impulse);
    m_rows.flush();
}

bool AcceleratedProjectedGradient::sweep(double tolerance)
{
    if (!(m_step > 0)) chooseStep();
    // Nesterov's extrapolation from the last two iterates, with restart where it points uphill [O'Donoghue, Candes
    // 2015].
    const double next = 0.5 * (1 + std::sqrt(1 + 4 * m_acceleration * m_acceleration));
    const double beta = (m_acceleration - 1) / next;
    std::vector<ContactRow>& rows = m_rows.rows();
    double largest = 0, uphill = 0;
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
        const ContactRow& row = rows[k];
        if (row.m_joint) continue;
        Memory& memory = m_memory[k];
        const Vec3 v = m_rows.velocity(row), before = row.m_impulse;
        const Vec3 from = before + beta * (before - memory.m_impulse);
        const Vec3 wanted = wantedImpulse(row, from, v + beta * (v - memory.m_velocity), m_step);
        uphill += row.m_rowCompliance.x * dot(from - wanted, wanted - before);
        largest = std::max(largest, speedOf(row, wanted - before));
        memory = {before, v, wanted};
    }
    for (std::size_t k = 0; k < rows.size(); ++k)
        if (!rows[k].m_joint) m_rows.change(rows[k], m_memory[k].m_next);
    m_rows.flush();
    m_lastSpeed = largest;
    m_acceleration = uphill > 0 ? 1 : next;
    const double joints = m_joints.solve();
    return std::max(m_rows.error(), m_rows.share(joints)) > tolerance;
}

}  // namespace bullet_fem
