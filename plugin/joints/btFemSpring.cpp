// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemSpring.h"

#include <cmath>

#include "bullet_fem/btFemRay.h"
#include "plugin/record/btFemRangeCheck.h"

namespace
{

constexpr double kMax = 1e12, kFarthestTarget = 1e6, kSumTolerance = 1e-4;

}  // namespace

btFemSpring btFemSpring::at(const btFemRayHit& hit)
{
    btFemSpring spring;
    for (int a = 0; a < 3; ++a)
    {
        spring.m_nodes[a] = hit.m_nodes[a];
        spring.m_weights[a] = hit.m_weights[a];
    }
    spring.m_target = hit.m_point;
    return spring;
}

bool btFemSpring::valid(std::string* why) const
{
    bool finite = true;
    for (int c = 0; c < 3; ++c)
    {
        finite = finite && std::isfinite(m_weights[c]);
        if (!btFemRangeCheck(std::fabs(m_target[c]) <= kFarthestTarget, why, "a coordinate of m_target", m_target[c],
                             "[-1e6, 1e6] m; give a place near the body"))
            return false;
    }
    const double sum = double(m_weights[0]) + double(m_weights[1]) + double(m_weights[2]);
    return btFemRangeCheck(finite && std::fabs(sum - 1) <= kSumTolerance, why, "the sum of m_weights", sum,
                           "[0.9999, 1.0001]; take them from a btFemRayHit") &&
           btFemRangeCheck(m_stiffness >= 0 && m_stiffness <= kMax, why, "m_stiffness", m_stiffness,
                           "[0, 1e12] N/m; mass / step^2 is a stiff one") &&
           btFemRangeCheck(m_damping >= 0 && m_damping <= kMax, why, "m_damping", m_damping,
                           "[0, 1e12] N s/m; 0 is usual") &&
           btFemRangeCheck(m_maxForce >= 0 && m_maxForce <= kMax, why, "m_maxForce", m_maxForce,
                           "[0, 1e12] N; 0 is no limit, 20 times the weight is usual");
}
