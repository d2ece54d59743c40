// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "plugin/record/btFemBodyRecord.h"

/// Ends the step of a body, and its nodes are written. May be called by several threads for different bodies.
void finishMotion(btFemBodyRecord& record, const bullet_fem::StepSettings& settings);

/// Normals of the nodes, while these are still in the cache.
void finishNodes(btFemBodyRecord& record);
