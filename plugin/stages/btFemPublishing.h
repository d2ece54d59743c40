// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "plugin/record/btFemBodyRecord.h"

/// When the step of a body is over: its nodes are written. May be called by several threads for different bodies.
void writeMotion(btFemBodyRecord& record);

/// Normals of the nodes, while these are still in the cache.
void finishNodes(btFemBodyRecord& record);
