// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/elements/law_points.h"

#include <cmath>

namespace bullet_fem
{

LawPoint lawPointOf(const RestShape& shape, int e, const double* history)
{
    const Material& material = shape.materialOf(e);
    const RestElement& element = shape.m_elements[e];
    LawPoint point;
    point.m_lambda = element.m_lambdaVolume / element.m_volume;
    point.m_mu = element.m_muVolume / element.m_volume;
    point.m_size = shape.lawSizeOf(e);
    point.m_constants = material.m_lawConstants.data();
    if (history) point.m_history = history + static_cast<std::size_t>(e) * shape.m_materials.historyCount();
    if (shape.isOrthotropic()) point.m_stiffness = &shape.stiffnessOf(e);
    return point;
}

}  // namespace bullet_fem
