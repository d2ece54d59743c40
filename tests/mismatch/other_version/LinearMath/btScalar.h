// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bullet's header with another version number.
#include_next <LinearMath/btScalar.h>
#undef BT_BULLET_VERSION
#define BT_BULLET_VERSION 1
