// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "plugin/record/btFemBodyRecord.h"

/// Writes a body's nodes at the end of its step. May be called by several threads for different bodies.
void writeMotion(btFemBodyRecord& record);

/// Updates the normals, while the nodes are still in the cache.
void finishNodes(btFemBodyRecord& record);
