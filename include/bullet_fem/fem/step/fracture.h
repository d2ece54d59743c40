// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

// Moved; this name goes with the next version.
#include "bullet_fem/fem/fracture/fracture.h"
