// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

// Deprecated header, moved to fem/body; to be removed in the next version.
#include "bullet_fem/fem/body/actuators.h"
