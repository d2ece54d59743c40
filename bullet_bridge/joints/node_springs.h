// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"

namespace bullet_fem
{

/// Makes a joint of every spring of body number `body`. After solveFreeMotion.
void appendSprings(int body, const JointScene& scene, ContactProblem& problem);

}  // namespace bullet_fem
