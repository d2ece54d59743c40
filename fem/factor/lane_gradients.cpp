// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/lane_gradients.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{
namespace
{

/// The conjugate gradient coefficients of all lanes.
class Lanes
{
public:
    explicit Lanes(double tolerance) : m_squaredTolerance(tolerance * tolerance) {}

    bool busy() const { return m_busy > 0; }

    /// beta for the next direction; ends lanes that have converged exactly.
    LaneNumbers turn(const LaneNumbers& rz)
    {
        LaneNumbers beta;
        for (int k = 0; k < kPanelLanes; ++k)
        {
            if (m_done[k]) continue;
            if (!(rz.m[k] > 0)) end(k);
            beta.m[k] = m_rz.m[k] > 0 ? rz.m[k] / m_rz.m[k] : 0;
        }
        m_rz = rz;
        return beta;
    }

    /// Step lengths along the directions; 0 in lanes that have ended.
    LaneNumbers advance(const LaneNumbers& pAp)
    {
        LaneNumbers step;
        for (int k = 0; k < kPanelLanes; ++k)
        {
            if (m_done[k]) continue;
            const double length = m_rz.m[k] / pAp.m[k], gained = length * m_rz.m[k];
            if (pAp.m[k] > 0 && std::isfinite(gained))
            {
                step.m[k] = length;
                m_energy[k] += gained;
            }
            if (!(gained > m_squaredTolerance * m_energy[k]) || step.m[k] == 0) end(k);
        }
        return step;
    }

private:
    void end(int lane)
    {
        m_done[lane] = true;
        --m_busy;
    }

    double m_squaredTolerance;
    LaneNumbers m_rz;
    double m_energy[kPanelLanes] = {};  // x . A x
    bool m_done[kPanelLanes] = {};
    int m_busy = kPanelLanes;
};

}  // namespace

LaneGradients::LaneGradients(const BodyModel& model)
    : m_factor(model.factor()),
      m_rigid(model),
      m_x(allocateFloats(static_cast<std::size_t>(m_factor.lower().size()) * kPanelLanes)),
      m_p(allocateFloats(static_cast<std::size_t>(m_factor.lower().size()) * kPanelLanes)),
      m_q(allocateFloats(static_cast<std::size_t>(m_factor.lower().size()) * kPanelLanes))
{
}

int LaneGradients::solve(double tolerance, float* y, float* scratch)
{
    const PackedFactor& P = m_factor.lower();
    const std::size_t size = static_cast<std::size_t>(P.size()) * kPanelLanes;
    const LaneVectors v = {P.size() / 3, m_x.get(), y, m_p.get(), m_q.get()};
    std::fill(v.m_x, v.m_x + size, 0.f);
    std::fill(v.m_p, v.m_p + size, 0.f);
    m_rigid.deflateRightSide(v.m_r);
    std::copy(v.m_r, v.m_r + size, v.m_q);
    Lanes lanes(tolerance);
    int iterations = 0;
    for (; iterations < kMaxIterations; ++iterations)
    {
        P.solveLanes(P.allSupernodes(), P.allSupernodes(), v.m_q, scratch);
        m_rigid.deflateSolution(v.m_q);
        const LaneNumbers beta = lanes.turn(dotLanes(v));
        if (!lanes.busy()) break;
        turnLanes(v, beta);
        advanceLanes(v, lanes.advance(multiplyLanes(m_factor.rest(), v)));
        if (!lanes.busy())
        {
            ++iterations;
            break;
        }
    }
    m_rigid.deflateSolution(v.m_x);
    std::copy(v.m_x, v.m_x + size, y);
    return iterations;
}

}  // namespace bullet_fem
