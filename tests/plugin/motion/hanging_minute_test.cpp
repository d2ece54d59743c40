// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/motion/hanging_scene.h"

namespace bullet_fem
{
namespace
{

class MinuteOfHanging : public Hanging
{
};

TEST_P(MinuteOfHanging, HoldsItsLoad)
{
    hang(60);
}

INSTANTIATE_TEST_SUITE_P(MassRatios, MinuteOfHanging,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(Loading::slow, Loading::dropped),
                                          testing::Values(Chain{1000, 1e-3, 1, 60}, Chain{1000, 1e-2, 1, 60},
                                                          Chain{1000, 0.1, 1, 60}, Chain{1000, 0.1, 1, 240},
                                                          Chain{1000, 0.1, 4, 60}, Chain{1000, 1e-2, 8, 60},
                                                          Chain{1e-3, 1e-2, 8, 60}, Chain{1, 1e-2, 8, 60})),
                         nameOf);

}  // namespace
}  // namespace bullet_fem
