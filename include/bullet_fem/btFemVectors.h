// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

// bullet_fem::vec3() and bullet_fem::bulletVector() convert vectors for Bullet programs.
#include "bullet_fem/bullet_bridge/vectors.h"
