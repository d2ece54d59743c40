// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"

namespace bullet_fem
{

/// Appends a joint for each spring of body `body`. Call after solveFreeMotion.
void appendSprings(int body, const JointScene& scene, ContactProblem& problem);

}  // namespace bullet_fem
