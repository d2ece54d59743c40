// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/elements/patch_frame.h"

#include "fem/common/rotation.h"

namespace bullet_fem
{

Mat3 deformationGradient(const RestShape& shape, int e, const std::vector<Vec3>& x)
{
    const Tet& tet = shape.m_mesh.tets()[e];
    const Vec3& x0 = x[tet[0]];
    return Mat3::fromColumns(x[tet[1]] - x0, x[tet[2]] - x0, x[tet[3]] - x0) * shape.m_elements[e].m_DmInverse;
}

Mat3 frameRotation(const RestShape& shape, int e, const std::vector<Vec3>& x, const Mat3& guess)
{
    if (shape.m_assumedStrain.empty()) return polarRotation(deformationGradient(shape, e, x), guess);
    const ElementPatches& patches = shape.m_patches;
    const int patch = patches.m_patch[e];
    Mat3 mean;
    for (int k = patches.m_start[patch]; k < patches.m_start[patch + 1]; ++k)
    {
        const int other = patches.m_element[k];
        mean += shape.shareOfPatch(other) * deformationGradient(shape, other, x);
    }
    return polarRotation(mean, guess);
}

}  // namespace bullet_fem
