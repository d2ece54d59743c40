// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/common/attempt.h"

using bullet_fem::succeeds;
