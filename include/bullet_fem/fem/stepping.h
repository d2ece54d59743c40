// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

// Deprecated name of 0.1, which many programs include; moved to fem/step.
#include "bullet_fem/fem/step/stepping.h"
