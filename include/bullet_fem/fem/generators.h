// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

// Deprecated name of 0.1, which many programs include; moved to fem/mesh.
#include "bullet_fem/fem/mesh/generators.h"
