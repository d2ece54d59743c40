// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/laws/mean_dilatation.h"

#include "fem/laws/volume_ratio.h"

namespace bullet_fem
{
namespace
{

double sharedModulus(const Law& law, const LawPoint& point)
{
    if (law.m_kind == LawKind::linear) return point.m_lambda + 2.0 / 3 * point.m_mu;
    return law.m_hasVolumeRatio ? point.m_lambda : 0;
}

}  // namespace

double volumeChange(const Law& law, const Mat3& e)
{
    if (!law.m_hasVolumeRatio) return trace(e);
    const double squares = squaredNorm(e), tr = trace(e);
    return tr + 0.5 * (tr * tr - squares) + determinant(e);
}

void shareWithPatch(const Law& law, double mean, LawPoint& point)
{
    const double shared = sharedModulus(law, point);
    point.m_lambda -= shared;
    point.m_pressure = shared * (law.m_hasVolumeRatio ? VolumeFunction(mean).m_slope : mean);
}

double sharedEnergy(const Law& law, double mean, const LawPoint& point)
{
    return sharedModulus(law, point) * (law.m_hasVolumeRatio ? VolumeFunction(mean).m_value : 0.5 * mean * mean);
}

}  // namespace bullet_fem
