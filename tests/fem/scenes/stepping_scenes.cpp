// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/scenes/stepping_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

bool atEnd(const Vec3& X)
{
    return X.x == 0;
}

}  // namespace

Material dampedMaterial(double young)
{
    Material material = elasticMaterial(young, 0.3);
    material.m_massDamping = 0.4;
    material.m_stiffnessDamping = 0.01;
    return material;
}

Body clampedBeam()
{
    return makeBody(makeBox({1, 0.4, 0.4}, {5, 2, 2}), dampedMaterial(), atEnd);
}

Body freeBlock()
{
    return makeBody(makeBox({1, 0.6, 0.5}, {3, 2, 2}), dampedMaterial());
}

void disturb(Body& body, unsigned seed)
{
    RandomVectors random(seed);
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
    {
        const Vec3 dx = 0.01 * random.next(), v = 0.5 * random.next();
        body.m_loads.m_force[i] = 3 * random.next();
        if (body.m_state.m_fixed[i]) continue;
        body.m_state.m_x[i] += dx;
        body.m_state.m_v[i] = v;
    }
}

void expectEnergyGradient(Body& body, const std::vector<Vec3>& forces, std::size_t stride)
{
    constexpr double kShift = 1e-6;  // [m]
    double most = 0;
    for (const Vec3& force : forces) most = std::max(most, norm(force));
    const std::vector<Vec3> x = body.m_state.m_x;
    for (std::size_t i = 0; i < x.size(); i += stride)
        for (int axis = 0; axis < 3; ++axis)
        {
            double energy[2];
            for (const int side : {0, 1})
            {
                body.m_state.m_x = x;
                body.m_state.m_x[i][axis] += side == 0 ? -kShift : kShift;
                energy[side] = mechanicalEnergy(body);
            }
            EXPECT_NEAR(forces[i][axis], -(energy[1] - energy[0]) / (2 * kShift), 1e-5 * most) << i << ", " << axis;
        }
}

}  // namespace bullet_fem
