// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/body/actuation.h"

#include <algorithm>
#include <cmath>

#include "fem/body/actuator_limits.h"

namespace bullet_fem
{
namespace
{

// g . u and out += scale g, for chambers and cables.

double dotGradient(const Chamber& chamber, const std::vector<Vec3>& g, const std::vector<Vec3>& u)
{
    double sum = 0;
    for (std::size_t t = 0; t < g.size(); ++t)
    {
        const Triangle& nodes = chamber.m_triangles[t];
        sum += dot(g[t], u[nodes[0]] + u[nodes[1]] + u[nodes[2]]);
    }
    return sum;
}

void addGradient(const Chamber& chamber, const std::vector<Vec3>& g, double scale, std::vector<Vec3>& out)
{
    for (std::size_t t = 0; t < g.size(); ++t)
    {
        const Vec3 part = scale * g[t];
        for (const int node : chamber.m_triangles[t]) out[node] += part;
    }
}

void addAt(const CablePoint& point, const Vec3& f, std::vector<Vec3>& out)
{
    for (int a = 0; a < 4; ++a)
        if (point.m_weights[a] != 0) out[point.m_nodes[a]] += point.m_weights[a] * f;
}

double dotGradient(const Cable& cable, const std::vector<Vec3>& g, const std::vector<Vec3>& u)
{
    double sum = 0;
    for (std::size_t k = 0; k < g.size(); ++k) sum += dot(g[k], cable.m_points[k + 1].at(u) - cable.m_points[k].at(u));
    return sum;
}

void addGradient(const Cable& cable, const std::vector<Vec3>& g, double scale, std::vector<Vec3>& out)
{
    for (std::size_t k = 0; k < g.size(); ++k)
    {
        addAt(cable.m_points[k], -scale * g[k], out);
        addAt(cable.m_points[k + 1], scale * g[k], out);
    }
}

// Regularization added to a small matrix's diagonal, as a share of it, so that actuators with equal gradients do not
// make it singular: above the rounding error of the preconditioner in single precision.
constexpr double kSmallRegularization = 1e-6;

// Calls visit(actuator k), chambers first.
template <class Visit>
void visitActuator(const Actuators& actuators, int k, const Visit& visit)
{
    const int chambers = static_cast<int>(actuators.m_chambers.size());
    if (k < chambers)
        visit(actuators.m_chambers[k]);
    else
        visit(actuators.m_cables[k - chambers]);
}

// Calls visit(actuator, its Pull) for all.
template <class Pulls, class Visit>
void forEachPull(const Actuators& actuators, Pulls& pulls, const Visit& visit)
{
    std::size_t k = 0;
    for (const Chamber& chamber : actuators.m_chambers) visit(chamber, pulls[k++]);
    for (const Cable& cable : actuators.m_cables) visit(cable, pulls[k++]);
}

}  // namespace

void Actuation::begin(const Actuators& actuators, const PullFactors& factors, const std::vector<Vec3>& y,
                      const std::vector<Vec3>& v)
{
    m_pulls.resize(actuators.m_chambers.size() + actuators.m_cables.size());
    m_stiff.clear();
    if (m_pulls.empty()) return;
    m_factors = factors;
    std::size_t k = 0;
    for (const Chamber& chamber : actuators.m_chambers) beginChamber(chamber, y, m_pulls[k++]);
    for (const Cable& cable : actuators.m_cables) beginCable(cable, y, v, m_pulls[k++]);
    m_Pg.resize(m_pulls.size());
    for (std::vector<Vec3>& Pg : m_Pg) Pg.resize(y.size());
    m_nodes.resize(y.size());
    m_small.resize(m_pulls.size() * m_pulls.size());
    m_t.resize(m_pulls.size());
    m_stiff.reserve(m_pulls.size());
    listStiff();
}

void Actuation::listStiff()
{
    m_stiff.clear();
    for (std::size_t k = 0; k < m_pulls.size(); ++k)
        if (m_pulls[k].m_pulls && m_pulls[k].m_stiffness > 0) m_stiff.push_back(static_cast<int>(k));
}

// dV/dx is a third of a triangle's area vector at each of its nodes, for a closed surface.
void Actuation::beginChamber(const Chamber& chamber, const std::vector<Vec3>& y, Pull& pull)
{
    pull.m_gradient.resize(chamber.m_triangles.size());
    pull.m_slope.clear();
    for (std::size_t t = 0; t < pull.m_gradient.size(); ++t)
    {
        const Triangle& nodes = chamber.m_triangles[t];
        const Vec3& origin = y[nodes[0]];
        pull.m_gradient[t] = (1.0 / 6) * cross(y[nodes[1]] - origin, y[nodes[2]] - origin);
    }
    const double volume = chamber.volume(y);
    pull.m_force = chamber.pressureAt(volume);
    pull.m_stiffness = 0;
    if (chamber.m_isSealed && chamber.m_gas > 0)  // p / V
        pull.m_stiffness = (pull.m_force + chamber.m_outsidePressure) / std::max(volume, chamber.m_gas / kMaxPressure);
    pull.m_rightSide = 0;
    pull.m_pulls = true;
}

// An elastic cable may pull in this step if it is taut, or would be at the step's end with the present velocities; see
// releaseSlack.
void Actuation::beginCable(const Cable& cable, const std::vector<Vec3>& y, const std::vector<Vec3>& v, Pull& pull) const
{
    pull.m_gradient.resize(cable.m_points.size() - 1);
    pull.m_slope.resize(pull.m_gradient.size());
    double length = 0;
    for (std::size_t k = 0; k < pull.m_gradient.size(); ++k)
    {
        const Vec3 part = cable.m_points[k + 1].at(y) - cable.m_points[k].at(y);
        const double partLength = norm(part), inverse = partLength > 0 ? 1 / partLength : 0;
        length += partLength;
        pull.m_gradient[k] = inverse * part;
        pull.m_slope[k] = inverse;
    }
    const double tension = cable.tensionAt(length);
    for (double& slope : pull.m_slope) slope *= m_factors.m_inMatrix * tension;
    pull.m_stiffness = cable.m_stiffness;
    pull.m_force = cable.m_stiffness > 0 ? -cable.m_stiffness * (length - cable.m_restLength) : -tension;
    const double stretching = m_factors.m_step * dotGradient(cable, pull.m_gradient, v);
    pull.m_pulls = pull.m_force <= 0 || pull.m_force - cable.m_stiffness * stretching < 0;
    pull.m_rightSide = 0;
}

void Actuation::addForces(const Actuators& actuators, const std::vector<Vec3>& v, std::vector<Vec3>& force)
{
    forEachPull(actuators, m_pulls,
                [&](const auto& actuator, Pull& pull)
                {
                    if (!pull.m_pulls) return;
                    double q = pull.m_force;
                    if (pull.m_stiffness > 0)
                        q -= pull.m_stiffness * m_factors.m_ofVelocity * dotGradient(actuator, pull.m_gradient, v);
                    pull.m_rightSide = m_factors.m_step * q;
                    addGradient(actuator, pull.m_gradient, q, force);
                });
}

void Actuation::subtractFromRightSide(const Actuators& actuators, const std::vector<Vec3>& in, std::vector<Vec3>& b)
{
    forEachPull(actuators, m_pulls,
                [&](const auto& actuator, Pull& pull)
                {
                    if (!pull.m_pulls) return;
                    const double part =
                        m_factors.m_inMatrix * pull.m_stiffness * dotGradient(actuator, pull.m_gradient, in);
                    pull.m_rightSide -= part;
                    addGradient(actuator, pull.m_gradient, -part, b);
                });
    addSlopes(actuators, -1, in, b);
}

void Actuation::addProduct(const Actuators& actuators, const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    forEachPull(actuators, m_pulls,
                [&](const auto& actuator, const Pull& pull)
                {
                    if (!pull.m_pulls || !(pull.m_stiffness > 0)) return;
                    const double rate = dotGradient(actuator, pull.m_gradient, in);
                    addGradient(actuator, pull.m_gradient, m_factors.m_inMatrix * pull.m_stiffness * rate, out);
                });
    addSlopes(actuators, 1, in, out);
}

// out += sign T in, with c h^2 tension / length (I - d d^T) between the ends of every straight segment.
void Actuation::addSlopes(const Actuators& actuators, double sign, const std::vector<Vec3>& in,
                          std::vector<Vec3>& out) const
{
    for (std::size_t c = 0; c < actuators.m_cables.size(); ++c)
    {
        const Cable& cable = actuators.m_cables[c];
        const Pull& pull = m_pulls[actuators.m_chambers.size() + c];
        for (std::size_t k = 0; k < pull.m_slope.size() && pull.m_pulls; ++k)
        {
            const Vec3& d = pull.m_gradient[k];
            const Vec3 apart = cable.m_points[k + 1].at(in) - cable.m_points[k].at(in);
            const Vec3 f = sign * pull.m_slope[k] * (apart - dot(d, apart) * d);
            addAt(cable.m_points[k], -f, out);
            addAt(cable.m_points[k + 1], f, out);
        }
    }
}

void Actuation::factor(const Actuators& actuators, const LinearOperator& preconditioner)
{
    const std::size_t m = m_stiff.size();
    for (std::size_t j = 0; j < m; ++j)
    {
        std::fill(m_nodes.begin(), m_nodes.end(), Vec3());
        visitActuator(actuators, m_stiff[j],
                      [&](const auto& actuator) { addGradient(actuator, m_pulls[m_stiff[j]].m_gradient, 1, m_nodes); });
        preconditioner.apply(m_nodes, m_Pg[j]);
    }
    for (std::size_t i = 0; i < m; ++i)
        visitActuator(actuators, m_stiff[i],
                      [&](const auto& actuator)
                      {
                          const Pull& pull = m_pulls[m_stiff[i]];
                          for (std::size_t j = 0; j <= i; ++j)
                              m_small[i * m + j] = dotGradient(actuator, pull.m_gradient, m_Pg[j]);
                          m_small[i * m + i] = (1 + kSmallRegularization) * m_small[i * m + i] +
                                               1 / (m_factors.m_inMatrix * pull.m_stiffness);
                      });
    for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j <= i; ++j)
        {
            double& entry = m_small[i * m + j];
            for (std::size_t k = 0; k < j; ++k) entry -= m_small[i * m + k] * m_small[j * m + k];
            entry = j < i ? entry / m_small[j * m + j] : std::sqrt(entry);
        }
}

// t <- (L L^T)^-1 t.
void Actuation::solveSmall(std::vector<double>& t) const
{
    const std::size_t m = m_stiff.size();
    for (std::size_t i = 0; i < m; ++i)
    {
        for (std::size_t k = 0; k < i; ++k) t[i] -= m_small[i * m + k] * t[k];
        t[i] /= m_small[i * m + i];
    }
    for (std::size_t i = m; i-- > 0;)
    {
        for (std::size_t k = i + 1; k < m; ++k) t[i] -= m_small[k * m + i] * t[k];
        t[i] /= m_small[i * m + i];
    }
}

void Actuation::correct(const Actuators& actuators, std::vector<Vec3>& Pr) const
{
    for (std::size_t j = 0; j < m_stiff.size(); ++j)
        visitActuator(actuators, m_stiff[j],
                      [&](const auto& actuator)
                      { m_t[j] = dotGradient(actuator, m_pulls[m_stiff[j]].m_gradient, Pr); });
    solveSmall(m_t);
    for (std::size_t j = 0; j < m_stiff.size(); ++j)
        for (std::size_t i = 0; i < Pr.size(); ++i) Pr[i] -= m_t[j] * m_Pg[j][i];
}

void Actuation::setRightSide(const Actuators& actuators, const std::vector<Vec3>& in)
{
    for (const int k : m_stiff)
        visitActuator(actuators, k,
                      [&](const auto& actuator)
                      {
                          Pull& pull = m_pulls[k];
                          pull.m_rightSide =
                              m_factors.m_inMatrix * pull.m_stiffness * dotGradient(actuator, pull.m_gradient, in);
                      });
}

// P G a with (D^-1 + G^T P G) a = D^-1 rho, D = c h^2 kappa, rho = m_rightSide (docs/theory.md, Actuators).
const std::vector<Vec3>& Actuation::lift()
{
    for (std::size_t j = 0; j < m_stiff.size(); ++j)
    {
        const Pull& pull = m_pulls[m_stiff[j]];
        m_t[j] = pull.m_rightSide / (m_factors.m_inMatrix * pull.m_stiffness);
    }
    solveSmall(m_t);
    std::fill(m_nodes.begin(), m_nodes.end(), Vec3());
    for (std::size_t j = 0; j < m_stiff.size(); ++j)
        for (std::size_t i = 0; i < m_nodes.size(); ++i) m_nodes[i] += m_t[j] * m_Pg[j][i];
    return m_nodes;
}

bool Actuation::releaseSlack(const Actuators& actuators, const std::vector<unsigned char>& fixed,
                             const std::vector<Vec3>& dv, std::vector<Vec3>& b)
{
    const std::vector<Cable>& cables = actuators.m_cables;
    bool released = false;
    for (std::size_t c = 0; c < cables.size(); ++c)
    {
        Pull& pull = m_pulls[actuators.m_chambers.size() + c];
        if (!pull.m_pulls || !(pull.m_stiffness > 0)) continue;
        const double impulse =
            pull.m_rightSide - m_factors.m_inMatrix * pull.m_stiffness * dotGradient(cables[c], pull.m_gradient, dv);
        if (!(impulse > 0)) continue;
        addGradient(cables[c], pull.m_gradient, -pull.m_rightSide, b);
        pull.m_pulls = false;
        released = true;
    }
    for (std::size_t i = 0; i < b.size() && released; ++i)
        if (fixed[i]) b[i] = {};
    if (released) listStiff();
    return released;
}

void Actuation::addReleased(const Actuators& actuators, std::vector<Vec3>& out) const
{
    forEachPull(actuators, m_pulls,
                [&](const auto& actuator, const Pull& pull)
                {
                    if (!pull.m_pulls) addGradient(actuator, pull.m_gradient, pull.m_rightSide, out);
                });
}

double Actuation::squaredForces(const Actuators& actuators) const
{
    double sum = 0;
    forEachPull(actuators, m_pulls,
                [&](const auto&, const Pull& pull)
                {
                    double squares = 0;
                    for (const Vec3& g : pull.m_gradient) squares += dot(g, g);
                    if (pull.m_pulls) sum += pull.m_force * pull.m_force * squares;
                });
    return sum;
}

}  // namespace bullet_fem
