// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bullet's header, as if it were of another version.
#include_next <LinearMath/btScalar.h>
#undef BT_BULLET_VERSION
#define BT_BULLET_VERSION 1
