// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// What tests ask Highway's library for, where BULLETFEM_VECTORS does without it: kernels are there for one target
// alone.
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
