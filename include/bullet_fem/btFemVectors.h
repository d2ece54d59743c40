// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

// For Bullet programs: bullet_fem::vec3() and bullet_fem::bulletVector().
#include "bullet_fem/bullet_bridge/vectors.h"
