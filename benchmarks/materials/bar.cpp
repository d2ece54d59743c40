// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/materials/bar.h"

#include <algorithm>
#include <utility>

#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

constexpr double kTolerance = 1e-8;  // of the linear solves
constexpr double kAtRest = 1e-9;     // largest displacement in a step that counts as rest [m]
constexpr int kMaxSteps = 2000;

Body makeBody(const TetMesh& mesh, const Material& material, double step,
              const std::function<bool(const Vec3& X)>& isFixed)
{
    const auto shape = std::make_shared<const RestShape>(mesh, material);
    FactorInput input;
    input.m_mass = shape->m_lumpedMass;
    input.m_step = step;
    for (const Vec3& X : mesh.restPositions()) input.m_fixed.push_back(isFixed && isFixed(X));
    return Body(BodyModel::create(shape, std::move(input)));
}

// Area per node in the plane at x: a third of each surface triangle there.
std::vector<double> areasAt(const TetMesh& mesh, double x)
{
    const std::vector<Vec3>& X = mesh.restPositions();
    std::vector<double> areas(X.size());
    for (const Triangle& t : mesh.surface())
        if (std::all_of(t.begin(), t.end(), [&](int node) { return std::abs(X[node].x - x) < 1e-9; }))
            for (const int node : t) areas[node] += norm(cross(X[t[1]] - X[t[0]], X[t[2]] - X[t[0]])) / 6;
    return areas;
}

}  // namespace

Bar::Bar(const TetMesh& mesh, const Material& material, double step, const std::function<bool(const Vec3& X)>& isFixed)
    : m_body(makeBody(mesh, material, step, isFixed)), m_step(step)
{
    for (const Vec3& X : mesh.restPositions()) m_length = std::max(m_length, X.x);
    m_near = areasAt(mesh, 0);
    m_far = areasAt(mesh, m_length);
}

void Bar::pull(double stress)
{
    const Vec3 axis = mean(m_far) - mean(m_near);
    for (std::size_t i = 0; i < m_far.size(); ++i)
        m_body.m_loads.m_force[i] = stress * (m_far[i] - m_near[i]) / norm(axis) * axis;
}

void Bar::load(const Vec3& force)
{
    double area = 0;
    for (const double a : m_far) area += a;
    for (std::size_t i = 0; i < m_far.size(); ++i) m_body.m_loads.m_force[i] = (m_far[i] / area) * force;
}

void Bar::step()
{
    StepSettings settings;
    settings.m_step = m_step;
    settings.m_tolerance = kTolerance;
    bullet_fem::step(m_body, settings);
}

void Bar::settle(const std::function<void()>& renew)
{
    double moved = 1;
    for (int k = 0; k < kMaxSteps && moved > kAtRest; ++k)
    {
        if (renew) renew();
        const std::vector<Vec3> before = m_body.m_state.m_x;
        std::fill(m_body.m_state.m_v.begin(), m_body.m_state.m_v.end(), Vec3());
        step();
        moved = 0;
        for (std::size_t i = 0; i < before.size(); ++i)
            moved = std::max(moved, norm(m_body.m_state.m_x[i] - before[i]));
    }
}

double Bar::strain() const
{
    return norm(mean(m_far) - mean(m_near)) / m_length - 1;
}

Vec3 Bar::endPosition() const
{
    return mean(m_far);
}

Vec3 Bar::mean(const std::vector<double>& areas) const
{
    Vec3 sum;
    double area = 0;
    for (std::size_t i = 0; i < areas.size(); ++i)
    {
        sum += areas[i] * m_body.m_state.m_x[i];
        area += areas[i];
    }
    return (1 / area) * sum;
}

}  // namespace bullet_fem
