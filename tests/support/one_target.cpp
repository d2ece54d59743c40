// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The functions of Highway's library that tests need when BULLETFEM_VECTORS is off: kernels exist for one target only.
#include <hwy/targets.h>

namespace hwy
{

int64_t SupportedTargets()
{
    return HWY_STATIC_TARGET;
}

void SetSupportedTargetsForTest(int64_t) {}

ChosenTarget& GetChosenTarget()
{
    static ChosenTarget chosen;
    return chosen;
}

}  // namespace hwy
