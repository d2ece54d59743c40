// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/scenes/stepping_scenes.h"

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

}  // namespace bullet_fem
